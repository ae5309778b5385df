// The event loop as a template on how balls accelerate: its declaration. event_loop_search.hpp says what a
// ball meets next, event_loop_candidates.hpp whom it looks at, event_loop_events.hpp what happens then;
// event_loop.cpp sets up, reads and instantiates.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include <carom/core/motion.hpp>

#include "event_loop.hpp"

namespace carom {

template <Acceleration kAcceleration>
class EventLoopOf final : public EventLoop {
 public:
    using EventLoop::EventLoop;

    void start() override;
    void predict_all(const Executor* executor) override;
    void advance_to(const Time& end, bool inclusive) override;
    void renew_field(const Time& t) override;
    void start_anew(const Time& t, std::span<const NewStart> starts) override;
    void audit(std::vector<Violation>& found) const override;
    void renew(std::uint32_t i, const BallRecord& record, const BallExtra& extra, bool is_owned,
               const Time& end) override;
    std::uint32_t enter(const BallRecord& record, const BallExtra& extra, bool is_owned,
                        const Time& end) override;
    void hand_over(std::uint32_t i, const Time& end) override;
    void remove(std::uint32_t i) override;
    void look_again(std::span<const std::uint32_t> balls) override;

 private:
    [[nodiscard]] Vec2 acceleration_of(std::uint32_t i) const {
        if constexpr (kAcceleration == Acceleration::kNone) return Vec2::Zero();
        if constexpr (kAcceleration == Acceleration::kUniform) return bodies_.physics.gravity;
        return acceleration_[i];
    }
    [[nodiscard]] Motion<double> motion_of(std::uint32_t i) const {
        const Anchor& a = records_[i].anchor;
        return {{a.x, a.y}, {a.vx, a.vy}, acceleration_of(i)};
    }
    [[nodiscard]] Vec2 offset_of(const Image& image) const { return bodies_.offset_of(image); }
    /// The smaller id first. Without a branch, for neither order is to be guessed.
    void put_in_order(std::uint32_t& i, std::uint32_t& j, Image& image) const {
        const auto is_swapped = static_cast<std::uint32_t>(records_[j].id() < records_[i].id());
        const std::int32_t sign = 1 - 2 * static_cast<std::int32_t>(is_swapped);
        image = {sign * image.x, sign * image.y};
        const std::uint32_t swap = (i ^ j) & -is_swapped;
        i ^= swap;
        j ^= swap;
    }
    /// A side of the domain as a half-plane: how far ball i is inside, and the motion of that gap.
    struct Gap {
        double distance, speed, acceleration;
    };
    [[nodiscard]] Gap gap_to_side(std::uint32_t i, Side side) const;

    // Prediction: pure functions of the anchors.
    /// kNever also where that is surely later than `limit`.
    [[nodiscard]] Time predict_pair(std::uint32_t i, std::uint32_t j, Image image, const Time& limit) const;
    [[nodiscard]] Time predict_fixed(std::uint32_t i, std::uint32_t id, Image image) const;
    [[nodiscard]] NextEvent predict_obstacle(std::uint32_t i, std::uint32_t obstacle, Image image) const;
    [[nodiscard]] NextEvent predict_side(std::uint32_t i, std::uint32_t side) const;
    [[nodiscard]] bool precedes(const NextEvent& a, const NextEvent& b, std::uint32_t i) const;

    // Search: what ball i can meet from the cells around it.
    [[nodiscard]] bool is_large(std::uint32_t i) const {
        return !large_.empty() && radius_of(i) > bodies_.largest_listed_radius;
    }
    /// How many cells away a ball may be and yet be touched before either centre crosses a border.
    [[nodiscard]] static std::int32_t reach(const GridAxis& axis, double radius_sum) {
        constexpr double kMost = 1 << 28;
        return 1 + static_cast<std::int32_t>(std::min(kMost, radius_sum * (1 + kCellMargin) / axis.width()));
    }
    [[nodiscard]] std::int32_t cell_reach(const GridAxis& axis, std::uint32_t i) const {
        return is_large(i) ? reach(axis, radius_of(i) + bodies_.largest_listed_radius) : 1;
    }
    [[nodiscard]] bool reaches_all(std::int32_t reach_x, std::int32_t reach_y) const {
        return reach_x > 1 && (2.0 * reach_x + 1) * (2.0 * reach_y + 1) > bodies_.grid.cell_count();
    }
    /// The images of a ball `offset` cells behind that lie within `reach` cells: first and last, none when
    /// the first is greater.
    [[nodiscard]] static std::pair<std::int32_t, std::int32_t> images_within(const GridAxis& axis,
                                                                             std::int32_t offset,
                                                                             std::int32_t reach) {
        if (!axis.periodic()) return std::abs(offset) <= reach ? std::pair(0, 0) : std::pair(1, 0);
        return {-axis.turns(reach - offset), axis.turns(offset + reach)};
    }
    void consider(std::uint32_t i, std::uint32_t j, Image image, NextEvent& best) const;
    void consider_in_cell(std::uint32_t i, std::uint32_t j, CellCoordinates cell, NextEvent& best) const;
    void consider_beside(std::uint32_t i, std::uint32_t j, CellCoordinates reach, NextEvent& best) const;
    [[gnu::noinline]] void consider_images(std::uint32_t i, std::uint32_t j, NextEvent& best) const;
    void scan_large(std::uint32_t i, NextEvent& best) const {
        if (!large_.empty()) scan_each_large(i, best);
    }
    [[gnu::noinline]] void scan_each_large(std::uint32_t i, NextEvent& best) const;
    void scan_listed(std::uint32_t i, NextEvent& best) const;
    [[gnu::noinline]] void scan_beside(std::uint32_t i, CellCoordinates side, NextEvent& best) const;
    static constexpr std::size_t kMostCandidates = std::size_t{9} * 6;  // that are looked at together
    struct Candidates {
        std::size_t count = 0;
        CellCoordinates reach{1, 1};  // how many cells away they may be
        // NOLINTBEGIN(*-member-init): not all of it is used
        std::array<std::uint32_t, kMostCandidates + kLanes> ids;
        std::array<Floats, (kMostCandidates + kLanes - 1) / kLanes> bounds;     // eight candidates each
        std::array<unsigned, (kMostCandidates + kLanes - 1) / kLanes> soonest;  // of the eight, a bit each
        // NOLINTEND(*-member-init)
    };
    void look(std::uint32_t i, Candidates& found) const;
    void choose(std::uint32_t i, const Candidates& found, NextEvent& best) const;
    [[nodiscard]] bool look_beside(std::uint32_t i, CellCoordinates side, Candidates& found) const;
    /// The cells of an axis at a distance, on one side or, where that is 0, on both: first and last.
    [[nodiscard]] static std::pair<std::int32_t, std::int32_t> beside(std::int32_t cell, std::int32_t side,
                                                                      std::int32_t reach) {
        return side == 0 ? std::pair(cell - reach, cell + reach)
                         : std::pair(cell + side * reach, cell + side * reach);
    }
    /// The ids of cells' first blocks, one after the other.
    struct Gathering {
        std::uint32_t* next;
        std::uint32_t links = 0;  // whether a cell has a further block
        void add(const CellLists::Block& block) {
            std::memcpy(next, &block, sizeof(block));
            next += block.count();
            links |= block.link;
        }
        /// All but one of them. Precondition: it is in the block, or the cell has a further one.
        void add_all_but(std::uint32_t i, const CellLists::Block& block) {
            const std::uint32_t last = block.ids[block.count() - 1];
            for (std::uint32_t k = 0; k < CellLists::kBlockSize; ++k)
                next[k] = block.ids[k] == i ? last : block.ids[k];
            next += block.count() - 1;
            links |= block.link;
        }
        [[nodiscard]] bool is_all() const { return links <= CellLists::kBlockSize; }
        void finish(Candidates& found) const {
            found.count = static_cast<std::size_t>(next - found.ids.data());
        }
    };
    bool gather_around(std::uint32_t i, Candidates& found) const;
    bool gather_row(std::int32_t middle, std::int32_t step, Candidates& found) const;
    [[gnu::noinline]] bool gather_at_border(std::uint32_t i, CellCoordinates side, Candidates& found) const;
    [[nodiscard]] bool gather_cell(std::uint32_t i, std::int32_t place, Candidates& found) const;
    [[gnu::noinline]] bool gather_more(std::uint32_t i, std::int32_t low, std::int32_t step, std::int32_t row,
                                       int rows, Candidates& found) const;
    void sight(std::uint32_t i);
    [[gnu::noinline]] void sight_all();
    template <class F>
    void for_each_place(std::uint32_t i, CellCoordinates first, CellCoordinates last, F&& f) const;
    void scan_obstacles(std::uint32_t i, NextEvent& best) const {
        if (bodies_.has_obstacles) scan_each_obstacle(i, best);
    }
    [[gnu::noinline]] void scan_each_obstacle(std::uint32_t i, NextEvent& best) const;
    [[nodiscard]] NextEvent search(std::uint32_t i) const {
        Candidates found;
        const bool has_looked = look_beside(i, {0, 0}, found);
        return search_among(i, found, has_looked);
    }
    [[nodiscard]] NextEvent search_among(std::uint32_t i, const Candidates& found, bool has_looked) const;
    void expect(std::uint32_t i, const NextEvent& event);
    /// Asks for the memory of a ball ahead of its use.
    void fetch(std::uint32_t i) const { carom::fetch(records_[i]); }
    /// Of one that will have an event.
    void fetch_own(std::uint32_t i) const {
        fetch(i);
        queue_.fetch(i);
        __builtin_prefetch(&locals_[i]);
    }
    /// That of its partner too, ahead of its event.
    void fetch_pair(std::uint32_t i) const {
        fetch_own(i);
        const std::uint32_t partner = records_[i].next.local;
        fetch_own(partner & -std::uint32_t{partner != kNowhere});
        const std::int32_t place = records_[i].place;
        const std::int32_t row = region_.x.size();
        cells_.fetch(place);
        cells_.fetch(std::max(place - row, 0));
        cells_.fetch(std::min(place + row, region_.size() - 1));
    }
    /// Whether an event's partner, looked for here, is still the one that it was predicted for.
    [[nodiscard]] bool is_current(const NextEvent& event) const {
        const BallRecord& partner = records_[event.local];
        return partner.anchor.stamp == event.stamp && partner.id() == event.partner;
    }
    void reschedule(std::uint32_t i) {
        if (const double key = key_of(i); key != queue_.key(i)) queue_.set(i, key);
    }
    [[gnu::noinline]] void lose(std::uint32_t i);
    [[gnu::noinline]] void tell_lower(std::uint32_t i);
    void relist(std::uint32_t i, CellCoordinates cell);
    void predict_crossing(std::uint32_t i);

    // Events.
    void run_in_parts(double end, bool inclusive);
    // Calls cost a tenth of the time here: what happens often is drawn into one function, and what is rare
    // kept out of it ([[gnu::noinline]]), for compilers do not know which is which.
    [[gnu::flatten]] void run_until(double end, bool inclusive);
    void start_next_epoch(std::int64_t epoch);
    [[nodiscard]] bool are_plainly_first(const EventQueue::Front& first) const;
    [[nodiscard, gnu::noinline]] std::uint32_t first_of_ties();
    [[nodiscard]] std::uint64_t most_events_at_once() const {
        return (is_patient ? 2'000'000 : 10'000) + 64 * std::uint64_t{size()};
    }
    [[noreturn, gnu::noinline]] void refuse_wedged(std::uint32_t i) const;
    [[gnu::noinline]] void make_room(double end);
    void cross(std::uint32_t i);
    void collide_first(std::uint32_t i);
    [[nodiscard, gnu::noinline]] std::uint32_t find_beside(std::uint32_t i, std::uint32_t id,
                                                           bool& is_inside) const;
    [[gnu::noinline]] void pass_on_notes();
    void collide_pair(std::uint32_t i, std::uint32_t j, Image image, const Time& t);
    [[gnu::noinline]] void keep_meeting(std::uint32_t i, std::uint32_t j, Image image, const Time& t);
    [[gnu::noinline, gnu::flatten]] void collide_obstacle(std::uint32_t i, const NextEvent& event);
    void keep_anchor(std::uint32_t i);
    Image advance(std::uint32_t i, const Time& t);
    // Two balls of an event side by side, where that is plain; see event_loop_pair.hpp.
    struct Pair {
        Doubles place, velocity;
    };
    [[nodiscard]] Pair pair_at(std::uint32_t i, std::uint32_t j, const Time& t) const;
    [[nodiscard]] bool is_plain(const Pair& pair) const;
    void anchor_pair(std::uint32_t i, std::uint32_t j, const Pair& pair, const Time& t);
    void settle_pair(std::uint32_t i, std::uint32_t j, const Pair& pair, const Time& t);
    void predict_crossings(std::uint32_t i, std::uint32_t j, const Pair& pair, const Doubles& cells);
    void settle(std::uint32_t i);
    [[nodiscard]] double restitution_at(double restitution, std::uint32_t i, std::uint32_t j,
                                        const Time& t) const;
    void note(const Time& t, std::uint32_t i, std::uint32_t partner, std::uint32_t partner_stamp,
              const Hit& hit);
    void remember(std::uint32_t i, const Time& t, std::uint32_t partner);
};

}  // namespace carom
