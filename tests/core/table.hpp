// Reads the tables of tests/references: comma-separated, a header line, fields in double quotes where they
// hold a comma.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace carom::test {

using Row = std::vector<std::string>;

inline Row split_row(const std::string& line) {
    Row fields(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    return fields;
}

/// All rows but the header.
inline std::vector<Row> read_table(const std::string& name) {
    const auto path = std::filesystem::path(CAROM_SOURCE_DIR) / "tests/references" / name;
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot open " + path.string());
    std::vector<Row> rows;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        if (!line.empty()) rows.push_back(split_row(line));
    }
    return rows;
}

}  // namespace carom::test
