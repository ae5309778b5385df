// The one place where threads come from.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace carom {

/// Runs loops on a fixed number of threads. What a loop computes must not depend on which thread runs which
/// part.
class Executor {
 public:
    /// `threads` <= 0: as many as the machine offers.
    explicit Executor(int threads);

    [[nodiscard]] int threads() const { return threads_; }
    /// Calls body(first, last) for disjoint parts of [0, count), each at most `grain` long, side by side.
    void for_ranges(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t, std::size_t)>& body) const;

    /// Calls each step for all of [0, count), side by side, one step when the one before is done for all.
    /// With no more of them than threads each keeps to its thread, and none sleeps between steps.
    using Step = std::function<void(std::size_t)>;
    void for_each_in_steps(std::size_t count, std::span<const Step> steps) const;

    /// Sum over [0, count) of part(first, last): the parts are cut and added in one order whatever the number
    /// of threads.
    template <class T, class Part>
    [[nodiscard]] T sum(std::size_t count, T zero, Part&& part) const {
        constexpr std::size_t kGrain = 4096;
        const std::size_t parts = (count + kGrain - 1) / kGrain;
        std::vector<T> partial(parts, zero);
        for_ranges(parts, 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t p = first; p < last; ++p)
                partial[p] = part(p * kGrain, std::min(count, (p + 1) * kGrain));
        });
        T total = zero;
        for (const T& p : partial) total += p;
        return total;
    }

 private:
    int threads_;
    std::shared_ptr<void> arena_;  // what the back end keeps
};

}  // namespace carom
