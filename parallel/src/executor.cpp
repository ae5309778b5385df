// Steps one after the other, the same whatever threads come from.
#include "executor.hpp"

#include <atomic>
#include <thread>

namespace carom {
namespace {

/// Threads that go through steps together. Who is done with a step looks whether another one's part has not
/// been begun, as its thread may not have come yet, and then waits without sleeping: what wakes a thread
/// takes longer than the others' parts do.
class Crew {
 public:
    Crew(std::size_t count, std::span<const Executor::Step> steps)
        : count_(count), steps_(steps), begun_(count * steps.size()), done_(steps.size()) {}

    /// Goes through all steps, with part `own` of each before any other one.
    void work(std::size_t own) {
        for (std::size_t s = 0; s < steps_.size() && !has_failed_; ++s) {
            for (std::size_t k = 0; k < count_; ++k) {
                const std::size_t part = (own + k) % count_;
                if (!begun_[s * count_ + part].exchange(true)) run(s, part);
            }
            while (done_[s] < count_) std::this_thread::yield();
        }
    }

 private:
    void run(std::size_t s, std::size_t part) {
        try {
            steps_[s](part);
        } catch (...) {
            has_failed_ = true;
            ++done_[s];  // who waits must see the failure first
            throw;
        }
        ++done_[s];
    }

    std::size_t count_;
    std::span<const Executor::Step> steps_;
    std::vector<std::atomic<bool>> begun_;        // a part of a step
    std::vector<std::atomic<std::size_t>> done_;  // parts of a step
    std::atomic<bool> has_failed_ = false;
};

}  // namespace

void Executor::for_each_in_steps(std::size_t count, std::span<const Step> steps) const {
    if (count > static_cast<std::size_t>(threads_)) {
        for (const Step& step : steps)
            for_ranges(count, 1, [&step](std::size_t first, std::size_t last) {
                for (std::size_t k = first; k < last; ++k) step(k);
            });
        return;
    }
    Crew crew(count, steps);
    for_ranges(count, 1, [&crew](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) crew.work(k);
    });
}

}  // namespace carom
