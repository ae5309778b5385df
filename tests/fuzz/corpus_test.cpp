// Every kept input again, in any build: those that were found to be taken wrongly, and the fuzzers' seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "inputs.hpp"

namespace carom::fuzz {
namespace {

void take_all(const char* folder, void (*take)(std::string_view)) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(CAROM_SOURCE_DIR) + folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    ASSERT_FALSE(files.empty());
    for (const auto& path : files) {
        SCOPED_TRACE(path.filename());
        std::ifstream file(path, std::ios::binary);
        take(std::string(std::istreambuf_iterator<char>(file), {}));
    }
}

TEST(Corpus, Scenes) {
    take_all("/tests/fuzz/corpus/scene", take_scene);
    take_all("/tests/io/broken_scenes", take_scene);
}
TEST(Corpus, Xyz) {
    take_all("/tests/fuzz/corpus/xyz", take_xyz);
}
TEST(Corpus, LammpsData) {
    take_all("/tests/fuzz/corpus/lammps", take_lammps);
}
TEST(Corpus, Checkpoints) {
    take_all("/tests/fuzz/corpus/checkpoint", take_checkpoint);
}

}  // namespace
}  // namespace carom::fuzz
