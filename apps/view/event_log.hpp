// What has happened to whom: every collision counted for its balls, the latest ones kept.
#pragma once

#include <cstdint>
#include <vector>

#include <carom/parallel/world.hpp>

namespace carom::app {

class EventLog {
 public:
    explicit EventLog(std::size_t balls, std::size_t kept = 1U << 16U) : counts_(balls, 0), kept_(kept) {}

    void note(const Collision& c);
    /// There are so many balls from now on, not fewer than before.
    void grow(std::size_t balls) { counts_.resize(balls, 0); }

    /// Collisions of each ball since the start.
    [[nodiscard]] const std::vector<std::uint32_t>& counts() const { return counts_; }
    [[nodiscard]] std::uint64_t total() const { return total_; }
    /// The latest collisions of a ball, the last one first, as far as they are kept: at most `most`.
    [[nodiscard]] std::vector<Collision> history_of(std::uint32_t ball, std::size_t most) const;

 private:
    std::vector<std::uint32_t> counts_;
    std::size_t kept_;
    std::vector<Collision> latest_;  // a ring: collision k at k modulo kept_
    std::uint64_t total_ = 0;
};

}  // namespace carom::app
