// The queue of next events: one time a ball, the earliest first.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace carom {

/// A winner tree over one key a ball. Among equal keys the smallest id wins, so that the order of events is
/// total. set() costs at most log2 N, less when the change does not reach the top; first() log2 N.
class EventQueue {
 public:
    EventQueue() = default;
    /// Takes all keys at once, in O(N).
    explicit EventQueue(std::size_t count)
        : leaves_(std::bit_ceil(std::max<std::size_t>(count, 1))),
          keys_(2 * leaves_, std::numeric_limits<double>::infinity()) {}

    /// Changes one key of many; call rebuild() before the next first().
    void put(std::uint32_t id, double key) { keys_[leaves_ + id] = key; }
    void rebuild() {
        for (std::size_t node = leaves_; --node > 0;)
            keys_[node] = std::min(keys_[2 * node], keys_[2 * node + 1]);
    }

    void set(std::uint32_t id, double key) {
        std::size_t node = leaves_ + id;
        keys_[node] = key;
        while (node >>= 1) {
            const double least = std::min(keys_[2 * node], keys_[2 * node + 1]);
            if (keys_[node] == least) break;
            keys_[node] = least;
        }
    }

    [[nodiscard]] double key(std::uint32_t id) const { return keys_[leaves_ + id]; }
    /// The least key; infinity when nothing is to come.
    [[nodiscard]] double first_key() const { return keys_[1]; }
    /// The smallest id with the least key.
    [[nodiscard]] std::uint32_t first() const {
        std::size_t node = 1;
        const double least = keys_[1];
        while (node < leaves_) node = 2 * node + (keys_[2 * node] == least ? 0 : 1);
        return static_cast<std::uint32_t>(node - leaves_);
    }

 private:
    std::size_t leaves_ = 1;
    std::vector<double> keys_;  // keys_[1] is the winner, the leaves start at leaves_
};

}  // namespace carom
