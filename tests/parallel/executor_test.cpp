// Steps side by side: each part of each once, none before the step before is done, and errors come out.
#include "executor.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace carom {
namespace {

// With more parts than threads, as many and fewer; the second step sees whether the first one is done.
TEST(Executor, StepsAreDoneOneAfterTheOtherAndEachPartOnce) {
    for (const int threads : {1, 2, 4}) {
        const Executor executor(threads);
        for (const std::size_t count : {0, 1, 2, 3, 4, 9}) {
            for (int repeat = 0; repeat < 20; ++repeat) {
                std::vector<std::atomic<int>> first(count), second(count);
                std::atomic<std::size_t> done = 0;
                std::atomic<int> too_early = 0;
                executor.for_each_in_steps(
                    count, std::array<Executor::Step, 2>{
                               [&](std::size_t k) {
                                   // While one takes long the others must not go on.
                                   if (k == 0) std::this_thread::sleep_for(std::chrono::microseconds(50));
                                   ++first[k];
                                   ++done;
                               },
                               [&](std::size_t k) {
                                   if (done != count) ++too_early;
                                   ++second[k];
                               },
                           });
                EXPECT_EQ(too_early, 0);
                for (std::size_t k = 0; k < count; ++k) {
                    EXPECT_EQ(first[k], 1) << threads << " threads, part " << k << " of " << count;
                    EXPECT_EQ(second[k], 1) << threads << " threads, part " << k << " of " << count;
                }
            }
        }
    }
}

TEST(Executor, AnErrorEndsTheStepsAndComesOut) {
    for (const int threads : {1, 2, 4}) {
        const Executor executor(threads);
        for (const std::size_t count : {1, 2, 4, 9}) {
            std::atomic<int> later = 0;
            std::string message;
            try {
                executor.for_each_in_steps(count, std::array<Executor::Step, 2>{
                                                      [&](std::size_t k) {
                                                          if (k == count - 1)
                                                              throw std::runtime_error("part");
                                                      },
                                                      [&](std::size_t) { ++later; },
                                                  });
            } catch (const std::runtime_error& error) {
                message = error.what();
            }
            EXPECT_EQ(message, "part");
            EXPECT_EQ(later, 0);
        }
    }
}

}  // namespace
}  // namespace carom
