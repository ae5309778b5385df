// The queue of next events: one time a ball, the earliest first.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace carom {

/// A tree of minima over one key a ball, sixteen children a node.
///
/// A node holds the key's upper bits with the ball's id below them, so that the root tells both and a change
/// that is not its node's winner stops at once. Keys that agree in those upper bits are told apart by their
/// full values, and equal ones by the smaller id, so that the order of events is total.
class EventQueue {
 public:
    EventQueue() = default;
    /// `count` entries, all at infinity.
    explicit EventQueue(std::size_t count) {
        reset(count);
        for (std::size_t i = 0; i < count; ++i) put(static_cast<std::uint32_t>(i), keys_[i]);
        rebuild();
    }

    /// `count` entries, each to be put() before rebuild().
    void reset(std::size_t count) {
        count_ = std::max<std::size_t>(count, 1);
        id_mask_ = std::bit_ceil(count_) - 1;
        keys_.assign(count_, std::numeric_limits<double>::infinity());
        levels_.clear();
        std::size_t size = 0;
        for (std::size_t nodes = count_; nodes > 1 || size == 0; nodes = (nodes + kWidth - 1) / kWidth) {
            const std::size_t padded = (nodes + kWidth - 1) / kWidth * kWidth;
            levels_.push_back(size);
            size += padded;
        }
        nodes_.assign(size, kEmpty);
    }

    /// Changes one key of many; call rebuild() before the next first(). Keys are >= 0, infinity included.
    void put(std::uint32_t id, double key) {
        keys_[id] = key;
        nodes_[id] = packed(id, key);
    }
    void rebuild() {
        for (std::size_t level = 1; level < levels_.size(); ++level)
            for (std::size_t child = levels_[level - 1]; child < levels_[level]; child += kWidth)
                nodes_[levels_[level] + (child - levels_[level - 1]) / kWidth] = least_of(child);
        root_ = least_of(levels_.back());
    }

    void set(std::uint32_t id, double key) {
        put(id, key);
        const std::uint64_t changed = nodes_[id];
        std::size_t place = id;
        for (std::size_t level = 1; level <= levels_.size(); ++level) {
            place /= kWidth;
            std::uint64_t& node = level < levels_.size() ? nodes_[levels_[level] + place] : root_;
            if (changed < node)
                node = changed;
            else if ((node & id_mask_) == id)
                node = least_of(levels_[level - 1] + place * kWidth);
            else
                return;
        }
    }

    [[nodiscard]] double key(std::uint32_t id) const { return keys_[id]; }
    /// The least key; infinity when nothing is to come.
    [[nodiscard]] double first_key() const { return keys_[first()]; }

    /// The smallest id with the least key.
    [[nodiscard]] std::uint32_t first() const {
        return first([](std::uint32_t id) { return id; });
    }
    /// The id with the least key; of equals the one whose rank(id) is lowest.
    template <class Rank>
    [[nodiscard]] std::uint32_t first(Rank&& rank) const {
        const std::uint32_t id = front();
        return is_shared(id) ? first_of_close(id, rank) : id;
    }
    /// An id with the least key. `may_be_tied` is set where more ids than one may have it, never left unset
    /// where they do.
    [[nodiscard]] std::uint32_t front(bool& may_be_tied) const {
        const std::uint32_t id = front();
        may_be_tied = is_shared(id);
        return may_be_tied ? first_of_close(id, [](std::uint32_t k) { return k; }) : id;
    }

    /// Calls f(id) for every id whose key equals the least one. Costs their number.
    template <class F>
    void for_each_first(F&& f) const {
        const double least = first_key();
        for_each_close([&](std::uint32_t id) {
            if (keys_[id] == least) f(id);
        });
    }

 private:
    static constexpr std::size_t kWidth = 16;
    static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

    [[nodiscard]] std::uint64_t packed(std::uint32_t id, double key) const {
        return (std::bit_cast<std::uint64_t>(key) & ~id_mask_) | id;
    }
    [[nodiscard]] std::uint64_t least_of(std::size_t child) const {
        const std::uint64_t* c = &nodes_[child];
        std::uint64_t least[kWidth / 2];
        for (std::size_t k = 0; k < kWidth / 2; ++k) least[k] = std::min(c[k], c[k + kWidth / 2]);
        for (std::size_t k = 0; k < kWidth / 4; ++k) least[k] = std::min(least[k], least[k + kWidth / 4]);
        return std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
    }
    [[nodiscard]] std::uint32_t front() const { return static_cast<std::uint32_t>(root_ & id_mask_); }
    template <class Rank>
    [[nodiscard]] std::uint32_t first_of_close(std::uint32_t id, Rank&& rank) const {
        std::uint32_t best = id;
        for_each_close([&](std::uint32_t other) {
            if (keys_[other] < keys_[best] || (keys_[other] == keys_[best] && rank(other) < rank(best)))
                best = other;
        });
        return best;
    }
    /// Whether another id agrees with the root's in the upper bits: it is a winner beside that one's path.
    [[nodiscard]] bool is_shared(std::uint32_t id) const {
        const std::uint64_t bits = root_ & ~id_mask_;
        std::size_t place = id;
        for (const std::size_t level : levels_) {
            const std::uint64_t* group = &nodes_[level + place / kWidth * kWidth];
            unsigned equal = 0;
            for (std::size_t k = 0; k < kWidth; ++k) equal += (group[k] & ~id_mask_) == bits ? 1U : 0U;
            if (equal > 1) return true;
            place /= kWidth;
        }
        return false;
    }
    /// Calls f for every id that agrees with the root in the upper bits.
    template <class F>
    void for_each_close(F&& f) const {
        visit_close(levels_.size(), 0, f);
    }
    template <class F>
    void visit_close(std::size_t level, std::size_t place, F& f) const {
        const std::size_t first = levels_[level - 1] + place * kWidth;
        for (std::size_t k = 0; k < kWidth; ++k) {
            if ((nodes_[first + k] & ~id_mask_) != (root_ & ~id_mask_)) continue;
            const std::size_t child = place * kWidth + k;
            if (level > 1)
                visit_close(level - 1, child, f);
            else if (child < count_)
                f(static_cast<std::uint32_t>(child));
        }
    }

    std::size_t count_ = 0;
    std::uint64_t id_mask_ = 0;
    std::uint64_t root_ = kEmpty;
    std::vector<std::size_t> levels_;  // where each level starts in nodes_, the leaves first
    std::vector<std::uint64_t> nodes_;
    std::vector<double> keys_;
};

}  // namespace carom
