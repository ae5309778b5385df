// A table as text in columns, or as Markdown for a page.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace carom::bench {

/// The first column of words, the others of numbers; the last of words again where `ends_in_words`.
struct Table {
    std::vector<std::vector<std::string>> rows;  ///< the first is the head
    bool ends_in_words = false;

    [[nodiscard]] bool is_words(std::size_t column) const {
        return column == 0 || (ends_in_words && column + 1 == rows.front().size());
    }

    [[nodiscard]] std::string as_markdown() const {
        std::string text;
        for (const auto& row : rows) {
            for (const std::string& cell : row) text += "| " + cell + " ";
            text += "|\n";
            if (&row != &rows.front()) continue;
            for (std::size_t c = 0; c < row.size(); ++c) text += is_words(c) ? "| --- " : "| ---: ";
            text += "|\n";
        }
        return text;
    }

    [[nodiscard]] std::string as_text() const {
        std::vector<std::size_t> widths(rows.front().size());
        for (const auto& row : rows)
            for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
        std::string text;
        for (const auto& row : rows) {
            for (std::size_t c = 0; c < row.size(); ++c) {
                const std::string blanks(widths[c] - row[c].size(), ' ');
                if (c > 0) text += "  ";
                text += is_words(c) ? row[c] + (c + 1 < row.size() ? blanks : "") : blanks + row[c];
            }
            text += "\n";
        }
        return text;
    }
};

}  // namespace carom::bench
