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
    static constexpr std::int32_t kBlockSize = 6;
    /// Half a cache line of ids: the first `count` are in the cell, more are in the block `next`, if >= 0.
    struct Block {
        std::int32_t count = 0;
        std::int32_t next = -1;
        std::array<std::uint32_t, kBlockSize> ids = {};
    };

    CellLists() = default;
    explicit CellLists(std::size_t cells) : blocks_(cells) {}

    /// Empties the lists and makes them so many.
    void reset(std::size_t cells) {
        blocks_.assign(cells, Block{});
        free_.clear();
    }

    void insert(std::int32_t cell, std::uint32_t id) {
        if (blocks_[cell].count == kBlockSize) {
            const std::int32_t full = take_block();
            blocks_[full] = blocks_[cell];
            blocks_[cell] = Block{0, full, {}};
        }
        Block& target = blocks_[cell];
        target.ids[target.count++] = id;
    }

    /// Precondition: `id` is in `cell`.
    void remove(std::int32_t cell, std::uint32_t id) {
        Block& first = blocks_[cell];
        std::uint32_t* place = find(cell, id);
        *place = first.ids[--first.count];
        if (first.count == 0 && first.next >= 0) {
            const std::int32_t spare = first.next;
            first = blocks_[spare];
            free_.push_back(spare);
        }
    }

    /// Calls f(id) for every id in the cell.
    template <class F>
    void for_each(std::int32_t cell, F&& f) const {
        for (std::int32_t b = cell; b >= 0; b = blocks_[b].next)
            for (std::int32_t k = 0; k < blocks_[b].count; ++k) f(blocks_[b].ids[k]);
    }

    [[nodiscard]] const Block& first_block(std::int32_t cell) const { return blocks_[cell]; }

 private:
    std::uint32_t* find(std::int32_t cell, std::uint32_t id) {
        for (std::int32_t b = cell;; b = blocks_[b].next)
            for (std::int32_t k = 0; k < blocks_[b].count; ++k)
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
