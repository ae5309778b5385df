// The tests' main program. Where CAROM_MUTATION_TRACE names a file, it gets a line a test: the name, its
// seconds, and the numbers of the mutants that it reaches ("17" or, where the changed form does not compile,
// "17!"). The first line is what is reached before any test.
#include <gtest/gtest.h>

#include <fstream>

#include "switch.hpp"

namespace {

class Trace : public testing::EmptyTestEventListener {
 public:
    explicit Trace(const char* path) : file_(path) { write("-", 0); }

    void OnTestStart(const testing::TestInfo&) override { carom_mutation::reached.fill(0); }
    void OnTestEnd(const testing::TestInfo& test) override {
        const auto milliseconds = static_cast<double>(test.result()->elapsed_time());
        write(std::string(test.test_suite_name()) + "." + test.name(), milliseconds / 1000);
    }

 private:
    void write(const std::string& name, double seconds) {
        file_ << name << ' ' << seconds;
        for (int n = 0; n < carom_mutation::kMost; ++n) {
            const char state = carom_mutation::reached[static_cast<std::size_t>(n)];
            if (state != 0) file_ << ' ' << n << (state == 2 ? "!" : "");
        }
        file_ << std::endl;
    }

    std::ofstream file_;
};

}  // namespace

int main(int count, char** words) {
    testing::InitGoogleTest(&count, words);
    if (const char* path = std::getenv("CAROM_MUTATION_TRACE"))
        testing::UnitTest::GetInstance()->listeners().Append(new Trace(path));
    return RUN_ALL_TESTS();
}
