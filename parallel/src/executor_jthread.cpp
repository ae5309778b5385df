// The executor on std::jthread, for builds under ThreadSanitizer: the packaged oneTBB is not instrumented,
// and what it does between its own threads would be reported as races.
#include "executor.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace carom {

Executor::Executor(int threads)
    : threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

void Executor::for_ranges(std::size_t count, std::size_t grain,
                          const std::function<void(std::size_t, std::size_t)>& body) const {
    const std::size_t parts = (count + grain - 1) / grain;
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t p = next++; p < parts; p = next++) {
            try {
                body(p * grain, std::min(count, (p + 1) * grain));
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
                next = parts;
            }
        }
    };
    {
        std::vector<std::jthread> others;
        const std::size_t wanted = std::min(parts, static_cast<std::size_t>(threads()));
        for (std::size_t k = 1; k < wanted; ++k) others.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace carom
