// The baseline: equal hard discs in a periodic square box, simulated event by event on one thread the way
// textbooks do it (cell lists, one next event a disc, a winner tree over those events). It uses none of
// Carom's libraries, so that it can serve as the denominator of a speed ratio and as an independent oracle of
// a trajectory.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tournament.hpp"

namespace carom {

/// One resolved collision of the baseline; i < j.
struct PlainEvent {
    double time;
    std::uint32_t i;
    std::uint32_t j;
};

/// Elastic discs of unit mass and one diameter in the box [0, side)^2, both axes periodic. Predictions are
/// made from the present, not from the discs' last events, so trajectories agree with another program's to
/// rounding that chaos then magnifies, not to the bit. Not thread-safe. The scheme is that of Lubachevsky, J.
/// Comput. Phys. 94, 255 (1991): partners are always mutual, and a disc whose partner is taken by a third
/// wakes when it would have collided, to look again. Memory: some 75 bytes a disc and 32 a cell, whose side
/// is 1 to 1.9 diameters.
class PlainSimulation {
 public:
    using Vector = std::array<double, 2>;

    /// One position and one velocity a disc; positions anywhere, they are wrapped. Throws
    /// std::invalid_argument when the arrays differ in length or are empty, a number is not finite, the box
    /// is less than three diameters wide or more than 60,000, or so many discs share a cell that they must
    /// overlap; other overlaps are not looked for.
    PlainSimulation(const std::vector<Vector>& positions, const std::vector<Vector>& velocities,
                    double diameter, double side);

    /// Resolves every event up to and including `time`; a time in the past does nothing.
    void advance_to(double time);
    /// Resolves the next `count` collisions; returns how many there were, fewer only when nothing will ever
    /// collide.
    std::uint64_t run_events(std::uint64_t count);

    [[nodiscard]] double time() const { return time_; }
    /// State at time(), in the order given to the constructor; positions lie in [0, side).
    [[nodiscard]] std::vector<Vector> positions() const;
    [[nodiscard]] std::vector<Vector> velocities() const;
    /// Changes the sign of every velocity; the discs then run back to where they came from.
    void reverse();

    [[nodiscard]] std::uint64_t collisions() const { return collisions_; }
    [[nodiscard]] std::uint64_t crossings() const { return crossings_; }  ///< a disc entered another cell
    [[nodiscard]] std::uint64_t wakings() const {
        return wakings_;
    }  ///< a disc whose partner had been taken looked again
    [[nodiscard]] double virial() const { return virial_; }  ///< sum over collisions of r_ij . impulse on i
    [[nodiscard]] double kinetic_energy() const;

    /// Appends every later collision to `log`; nullptr turns it off. The log must outlive its use.
    void log_to(std::vector<PlainEvent>* log) { log_ = log; }

 private:
    static constexpr std::int32_t kNobody = -1;
    static constexpr int kCellCapacity = 7;

    struct alignas(64) Disc {
        double x, y, vx, vy;  // at time t
        double t;
        double impact;         // with the partner, or when to look for one again
        double crossing;       // when it leaves its cell
        std::int32_t partner;  // whose partner this disc is in turn
        std::uint16_t column, row;
    };
    struct alignas(32) Cell {
        std::int32_t count = 0;
        std::int32_t disc[kCellCapacity] = {};
    };
    struct Search;  // for the earliest impact of one disc

    bool resolve_next(double horizon);
    void collide(std::uint32_t i, double now);
    void cross(std::uint32_t i, double now);
    void predict_impact(std::uint32_t i, double now);
    void predict_crossing(Disc& disc) const;
    void search_cell(Search& search, int column, int row) const;
    void pair_up(const Search& search);
    void schedule(std::uint32_t i) {
        next_.set(i, discs_[i].impact < discs_[i].crossing ? discs_[i].impact : discs_[i].crossing);
    }
    void predict_all();
    void enter(std::uint32_t i, int column, int row);
    void leave(std::uint32_t i);
    void choose_cells(std::size_t count);
    [[nodiscard]] Vector leaving_times(const Disc& disc) const;
    void wrap(int& cell, double& x) const;
    [[nodiscard]] double nearest_image(double distance) const;
    static void move(Disc& disc, double now);

    double diameter_, side_;
    double cell_side_ = 0;
    int across_ = 0;  // cells along a side
    std::vector<Disc> discs_;
    std::vector<Cell> cells_;
    plain::Tournament next_;
    double time_ = 0;
    std::uint64_t collisions_ = 0, crossings_ = 0, wakings_ = 0;
    double virial_ = 0;
    std::vector<PlainEvent>* log_ = nullptr;
};

}  // namespace carom
