// Who is in which storage cell of a grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom {

/// Lists of ids, one a cell, that take any number. A cell's first block lies in one array; further blocks,
/// rare when the cell's width suits the scene, come from a pool. All operations cost the cell's number of
/// blocks.
class CellLists {
 public:
    static constexpr std::uint32_t kBlockSize = 3;
    /// A quarter of a cache line: ids of the cell, in no order.
    struct alignas(16) Block {
        std::array<std::uint32_t, kBlockSize> ids = {};
        std::uint32_t link = 0;  ///< how many there are, and where the cell's next block is

        [[nodiscard]] std::uint32_t count() const { return link % (kBlockSize + 1); }
        [[nodiscard]] bool has_next() const { return link > kBlockSize; }
        /// The next block's place. Precondition: there is one.
        [[nodiscard]] std::int32_t next() const {
            return static_cast<std::int32_t>(link / (kBlockSize + 1)) - 1;
        }
    };

    CellLists() = default;
    explicit CellLists(std::size_t cells) : blocks_(cells) {}

    /// Empties the lists and makes them so many.
    void reset(std::size_t cells) {
        blocks_.assign(cells, Block{});
        free_.clear();
    }

    void insert(std::int32_t cell, std::uint32_t id) {
        if (blocks_[cell].count() == kBlockSize) {
            const std::int32_t full = take_block();
            blocks_[full] = blocks_[cell];
            blocks_[cell] = Block{{}, static_cast<std::uint32_t>(full + 1) * (kBlockSize + 1)};
        }
        Block& target = blocks_[cell];
        target.ids[target.count()] = id;
        ++target.link;
    }

    /// Precondition: `id` is in `cell`.
    void remove(std::int32_t cell, std::uint32_t id) {
        Block& first = blocks_[cell];
        std::uint32_t* place = find(cell, id);
        --first.link;
        *place = first.ids[first.count()];
        if (first.count() == 0 && first.has_next()) {
            const std::int32_t spare = first.next();
            first = blocks_[spare];
            free_.push_back(spare);
        }
    }

    /// Calls f(id) for every id in the cell.
    template <class F>
    void for_each(std::int32_t cell, F&& f) const {
        for (const Block* b = &blocks_[cell]; b != nullptr; b = next(*b))
            for (std::uint32_t k = 0; k < b->count(); ++k) f(b->ids[k]);
    }

    /// Asks for the memory of a cell's list ahead of its use.
    void fetch(std::int32_t cell) const { __builtin_prefetch(&blocks_[cell]); }
    [[nodiscard]] const Block& first_block(std::int32_t cell) const { return blocks_[cell]; }
    /// The block after one; nullptr after the last.
    [[nodiscard]] const Block* next(const Block& block) const {
        return block.has_next() ? &blocks_[block.next()] : nullptr;
    }

 private:
    std::uint32_t* find(std::int32_t cell, std::uint32_t id) {
        for (std::int32_t b = cell;; b = blocks_[b].next())
            for (std::uint32_t k = 0; k < blocks_[b].count(); ++k)
                if (blocks_[b].ids[k] == id) return &blocks_[b].ids[k];
    }

    std::int32_t take_block() {
        if (!free_.empty()) {
            const std::int32_t block = free_.back();
            free_.pop_back();
            return block;
        }
        blocks_.emplace_back();
        return static_cast<std::int32_t>(blocks_.size() - 1);
    }

    std::vector<Block> blocks_;
    std::vector<std::int32_t> free_;
};

}  // namespace carom
