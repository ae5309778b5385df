// The baseline's events: which disc meets which, when it leaves its cell, and what happens then.
#include "plain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace carom {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// In diameters. Eight points that are a diameter apart need a square of side 1.93 (Schaer and Meir, Canad.
// Math. Bull. 8, 21 (1965)), so a cell's seven places suffice.
constexpr double kLargestCell = 1.9;
constexpr double kSmallestCell = 1 + 1e-9;  // a pair is seen before it touches, whatever the rounding
constexpr double kMostCells = 60000;        // along a side: columns and rows fit 16 bits

}  // namespace

// The disc that looks for a partner, at the present, and the best found.
struct PlainSimulation::Search {
    std::uint32_t self;
    double now;
    double x, y, vx, vy;
    double impact;
    std::int32_t partner = kNobody;
};

PlainSimulation::PlainSimulation(const std::vector<Vector>& positions, const std::vector<Vector>& velocities,
                                 double diameter, double side)
    : diameter_(diameter),
      side_(side),
      discs_(positions.size()),
      next_(std::max<std::size_t>(1, positions.size())) {
    if (positions.empty() || positions.size() != velocities.size() || positions.size() > 0x7fffffff) {
        throw std::invalid_argument(
            "PlainSimulation: needs one velocity for each position, and at least one");
    }
    if (!(diameter > 0) || !(side >= 3 * kSmallestCell * diameter) || !(side <= kMostCells * diameter)) {
        throw std::invalid_argument("PlainSimulation: the box must be 3 to 60,000 diameters wide");
    }
    choose_cells(positions.size());
    for (std::uint32_t i = 0; i < discs_.size(); ++i) {
        const auto [x, y] = positions[i];
        const auto [vx, vy] = velocities[i];
        if (!std::isfinite(x + y + vx + vy))
            throw std::invalid_argument("PlainSimulation: a number is not finite");
        const double wrapped_x = x - side_ * std::floor(x / side_),
                     wrapped_y = y - side_ * std::floor(y / side_);
        discs_[i] = {wrapped_x, wrapped_y, vx, vy, 0, kInfinity, kInfinity, kNobody, 0, 0};
        enter(i, std::min(across_ - 1, static_cast<int>(wrapped_x / cell_side_)),
              std::min(across_ - 1, static_cast<int>(wrapped_y / cell_side_)));
    }
    predict_all();
}

// Dilute gases do with fewer crossings in larger cells, dense ones with fewer neighbours in smaller cells.
void PlainSimulation::choose_cells(std::size_t count) {
    const double spacing = side_ / std::sqrt(static_cast<double>(count));
    const double wish = diameter_ * std::clamp(0.9 * spacing / diameter_, kSmallestCell, kLargestCell);
    const double fewest = std::ceil(side_ / (kLargestCell * diameter_));
    across_ = static_cast<int>(std::max({3.0, fewest, std::floor(side_ / wish)}));
    cell_side_ = side_ / across_;
    cells_.assign(static_cast<std::size_t>(across_) * static_cast<std::size_t>(across_), {});
}

void PlainSimulation::predict_all() {
    for (Disc& disc : discs_) {
        disc.impact = kInfinity;
        disc.partner = kNobody;
        predict_crossing(disc);
    }
    for (std::uint32_t i = 0; i < discs_.size(); ++i) predict_impact(i, time_);
}

void PlainSimulation::enter(std::uint32_t i, int column, int row) {
    Cell& cell = cells_[static_cast<std::size_t>(row) * across_ + column];
    if (cell.count == kCellCapacity) throw std::invalid_argument("PlainSimulation: discs overlap");
    cell.disc[cell.count++] = static_cast<std::int32_t>(i);
    discs_[i].column = static_cast<std::uint16_t>(column);
    discs_[i].row = static_cast<std::uint16_t>(row);
}

void PlainSimulation::leave(std::uint32_t i) {
    Cell& cell = cells_[static_cast<std::size_t>(discs_[i].row) * across_ + discs_[i].column];
    std::int32_t* place = cell.disc;
    while (*place != static_cast<std::int32_t>(i)) ++place;
    *place = cell.disc[--cell.count];
}

void PlainSimulation::move(Disc& disc, double now) {
    disc.x += disc.vx * (now - disc.t);
    disc.y += disc.vy * (now - disc.t);
    disc.t = now;
}

// Brings a column or row that lies one outside the grid to the other side, and the coordinate with it.
void PlainSimulation::wrap(int& cell, double& x) const {
    if (cell < 0) {
        cell += across_;
        x += side_;
    } else if (cell >= across_) {
        cell -= across_;
        x -= side_;
    }
}

double PlainSimulation::nearest_image(double distance) const {
    if (distance > side_ / 2) return distance - side_;
    if (distance < -side_ / 2) return distance + side_;
    return distance;
}

// How long until the disc reaches the side of its cell that it heads for, along x and along y.
PlainSimulation::Vector PlainSimulation::leaving_times(const Disc& disc) const {
    const auto along = [this](double x, double v, int cell) {
        if (v == 0) return kInfinity;
        return std::max(0.0, (cell_side_ * (v > 0 ? cell + 1 : cell) - x) / v);
    };
    return {along(disc.x, disc.vx, disc.column), along(disc.y, disc.vy, disc.row)};
}

void PlainSimulation::predict_crossing(Disc& disc) const {
    const auto [along_x, along_y] = leaving_times(disc);
    disc.crossing = disc.t + std::min(along_x, along_y);
}

// Tests the discs of one cell; column and row lie at most one outside the grid, and the discs are then taken
// from the other side. A disc that has an earlier impact is no candidate: it will not be there.
void PlainSimulation::search_cell(Search& search, int column, int row) const {
    double x = search.x, y = search.y;
    wrap(column, x);
    wrap(row, y);
    const Cell& cell = cells_[static_cast<std::size_t>(row) * across_ + column];
    for (int k = 0; k < cell.count; ++k) {
        const Disc& other = discs_[cell.disc[k]];
        const double rx = x - (other.x + other.vx * (search.now - other.t));
        const double ry = y - (other.y + other.vy * (search.now - other.t));
        const double wx = search.vx - other.vx, wy = search.vy - other.vy;
        const double approach = rx * wx + ry * wy;
        if (approach >= 0) continue;  // receding; so is a disc from itself
        const double turn = rx * wy - ry * wx;
        const double discriminant = diameter_ * diameter_ * (wx * wx + wy * wy) - turn * turn;
        if (discriminant < 0) continue;
        const double gap = rx * rx + ry * ry - diameter_ * diameter_;
        const double impact = search.now + std::max(0.0, gap / (std::sqrt(discriminant) - approach));
        if (impact < search.impact && impact < other.impact) {
            search.impact = impact;
            search.partner = cell.disc[k];
        }
    }
}

// Makes the searcher and the disc found each other's partners. Whom they leave keeps its time of waking.
void PlainSimulation::pair_up(const Search& search) {
    if (search.partner == kNobody) return;
    const std::uint32_t i = search.self;
    const auto j = static_cast<std::uint32_t>(search.partner);
    for (const std::uint32_t k : {i, j}) {
        if (discs_[k].partner != kNobody) discs_[discs_[k].partner].partner = kNobody;
    }
    discs_[i].partner = static_cast<std::int32_t>(j);
    discs_[j].partner = static_cast<std::int32_t>(i);
    discs_[i].impact = discs_[j].impact = search.impact;
    schedule(j);
}

// A disc that has a partner keeps it unless there is an earlier impact.
void PlainSimulation::predict_impact(std::uint32_t i, double now) {
    Disc& disc = discs_[i];
    const double since = now - disc.t;
    if (disc.partner == kNobody) disc.impact = kInfinity;
    Search search{i, now, disc.x + disc.vx * since, disc.y + disc.vy * since, disc.vx, disc.vy, disc.impact};
    for (int row = disc.row - 1; row <= disc.row + 1; ++row) {
        for (int column = disc.column - 1; column <= disc.column + 1; ++column)
            search_cell(search, column, row);
    }
    pair_up(search);
    schedule(i);
}

void PlainSimulation::collide(std::uint32_t i, double now) {
    Disc& a = discs_[i];
    const auto j = static_cast<std::uint32_t>(a.partner);
    Disc& b = discs_[j];
    move(a, now);
    move(b, now);
    const double rx = nearest_image(a.x - b.x), ry = nearest_image(a.y - b.y);
    const double approach = rx * (a.vx - b.vx) + ry * (a.vy - b.vy);
    const double share = approach / (rx * rx + ry * ry);
    a.vx -= share * rx, a.vy -= share * ry;
    b.vx += share * rx, b.vy += share * ry;
    virial_ -= approach;
    ++collisions_;
    if (log_ != nullptr) log_->push_back({now, std::min(i, j), std::max(i, j)});
    a.partner = b.partner = kNobody;
    a.impact = b.impact = kInfinity;  // both are free for each other and for anyone
    predict_crossing(a);
    predict_crossing(b);
    predict_impact(i, now);
    predict_impact(j, now);
}

void PlainSimulation::cross(std::uint32_t i, double now) {
    Disc& disc = discs_[i];
    const auto [along_x, along_y] = leaving_times(disc);
    const bool sideways = along_x <= along_y;
    leave(i);
    move(disc, now);
    int column = disc.column, row = disc.row;
    if (sideways) {
        column += disc.vx > 0 ? 1 : -1;
        wrap(column, disc.x);
    } else {
        row += disc.vy > 0 ? 1 : -1;
        wrap(row, disc.y);
    }
    enter(i, column, row);
    predict_crossing(disc);
    ++crossings_;

    Search search{i, now, disc.x, disc.y, disc.vx, disc.vy, disc.impact};
    for (int k = -1; k <= 1; ++k) {
        const int ahead = (sideways ? disc.vx : disc.vy) > 0 ? 1 : -1;
        search_cell(search, column + (sideways ? ahead : k), row + (sideways ? k : ahead));
    }
    pair_up(search);
    schedule(i);
}

// Resolves the earliest event unless it comes after the horizon; says whether it did.
bool PlainSimulation::resolve_next(double horizon) {
    const double now = next_.earliest_time();
    if (!(now <= horizon) || now == kInfinity) return false;
    const std::uint32_t i = next_.earliest();
    const Disc& disc = discs_[i];
    time_ = now;
    if (disc.crossing < disc.impact) {
        cross(i, now);
    } else if (disc.partner == kNobody) {
        ++wakings_;
        predict_impact(i, now);
    } else {
        collide(i, now);
    }
    return true;
}

void PlainSimulation::advance_to(double time) {
    while (resolve_next(time)) {
    }
    time_ = std::max(time_, time);
}

std::uint64_t PlainSimulation::run_events(std::uint64_t count) {
    const std::uint64_t before = collisions_;
    while (collisions_ - before < count && resolve_next(kInfinity)) {
    }
    return collisions_ - before;
}

void PlainSimulation::reverse() {
    for (Disc& disc : discs_) {
        move(disc, time_);
        disc.vx = -disc.vx, disc.vy = -disc.vy;
    }
    predict_all();
}

std::vector<PlainSimulation::Vector> PlainSimulation::positions() const {
    std::vector<Vector> result;
    result.reserve(discs_.size());
    const auto wrapped = [this](double x) {
        x -= side_ * std::floor(x / side_);
        return x < side_ ? x : 0.0;
    };
    for (const Disc& disc : discs_) {
        const double since = time_ - disc.t;
        result.push_back({wrapped(disc.x + disc.vx * since), wrapped(disc.y + disc.vy * since)});
    }
    return result;
}

std::vector<PlainSimulation::Vector> PlainSimulation::velocities() const {
    std::vector<Vector> result;
    result.reserve(discs_.size());
    for (const Disc& disc : discs_) result.push_back({disc.vx, disc.vy});
    return result;
}

double PlainSimulation::kinetic_energy() const {
    double twice = 0;
    for (const Disc& disc : discs_) twice += disc.vx * disc.vx + disc.vy * disc.vy;
    return twice / 2;
}

}  // namespace carom
