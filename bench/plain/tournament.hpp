// A winner tree over the next events' times: one leaf a disc, each knot the earliest of its eight children,
// which are a cache line.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace carom::plain {

/// The earliest of many times that change one by one. Setting costs at most log8(leaves) lines of memory and
/// stops at the first knot that does not change; finding the earliest costs the same.
class Tournament {
 public:
    /// All times start at infinity. Precondition: leaves > 0.
    explicit Tournament(std::size_t leaves) {
        std::size_t width = leaves;
        do {
            width = (width + kFan - 1) / kFan;
            levels_.emplace_back(width, Knot{});
        } while (width > 1);
    }

    [[nodiscard]] double time(std::uint32_t leaf) const { return levels_[0][leaf / kFan].child[leaf % kFan]; }
    [[nodiscard]] double earliest_time() const { return earliest_of(levels_.back()[0]); }

    /// The leaf with the earliest time, the smallest of equals.
    [[nodiscard]] std::uint32_t earliest() const {
        std::uint32_t at = 0;
        for (std::size_t level = levels_.size(); level-- > 0;) at = at * kFan + winner_of(levels_[level][at]);
        return at;
    }

    void set(std::uint32_t leaf, double time) {
        for (std::vector<Knot>& level : levels_) {
            Knot& knot = level[leaf / kFan];
            if (knot.child[leaf % kFan] == time) return;
            knot.child[leaf % kFan] = time;
            time = earliest_of(knot);
            leaf /= kFan;
        }
    }

 private:
    static constexpr std::uint32_t kFan = 8;
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    struct alignas(64) Knot {
        double child[kFan] = {kInfinity, kInfinity, kInfinity, kInfinity,
                              kInfinity, kInfinity, kInfinity, kInfinity};
    };

    static double earliest_of(const Knot& knot) {
        const double* c = knot.child;
        return std::min(std::min(std::min(c[0], c[1]), std::min(c[2], c[3])),
                        std::min(std::min(c[4], c[5]), std::min(c[6], c[7])));
    }
    static std::uint32_t winner_of(const Knot& knot) {
        const double first = earliest_of(knot);
        std::uint32_t at = 0;
        while (knot.child[at] != first) ++at;
        return at;
    }

    std::vector<std::vector<Knot>> levels_;  // from the leaves to the root
};

}  // namespace carom::plain
