// The steps of the empirical method: when they end, how balls go from one to the next, and how they are read.
#include "empirical_engine.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace carom {
namespace {

constexpr std::size_t kGrain = 4096;
// Balls that are near in the plane are put near in memory every so many steps.
constexpr std::uint64_t kStepsOfOrder = 64;

}  // namespace

EmpiricalEngine::EmpiricalEngine(const Bodies& bodies, const EngineStart& start, const Executor& executor,
                                 bool count_missed)
    : Engine(bodies, start),
      executor_(executor),
      steps_(bodies.physics.empirical.value_or(EmpiricalSteps{})),
      clock_(bodies.physics.clock),
      counts_missed_(count_missed),
      grid_(bodies.grid),
      now_(start.records.empty() ? start.now : start.records.front().anchor.time) {
    slot_of_.assign(bodies.count, kNowhere);
    for (std::size_t k = 0; k < start.records.size(); ++k) {
        const BallRecord& record = start.records[k];
        if (record.anchor.time != now_) throw SnapshotError("holds balls at different times");
        slot_of_[record.id()] = static_cast<std::uint32_t>(id_.size());
        id_.push_back(record.id());
        x_.push_back(record.anchor.x);
        y_.push_back(record.anchor.y);
        vx_.push_back(record.anchor.vx);
        vy_.push_back(record.anchor.vy);
        periods_.push_back(record.periods);
        if (!bodies.radius.is_one()) radius_.push_back(bodies.radius.of(record.id()));
        if (bodies.physics.contact_time > 0) last_collision_.push_back(start.extras[k].last_collision);
        if (bodies.accelerates_each()) acceleration_.push_back(start.extras[k].acceleration);
        if (!bodies.large.empty())
            is_large_.push_back(std::ranges::binary_search(bodies.large, record.id()) ? 1 : 0);
    }
    for (const std::uint32_t id : bodies.large) large_.push_back(slot_of_[id]);
    wrapped_x_.resize(size());
    wrapped_y_.resize(size());
    if (bodies.grid.x.periodic() || bodies.grid.y.periodic()) turns_.resize(size());
    if (count_missed) travel_.resize(size());
    touched_index_.assign(size(), kNowhere);
    first_touched_.assign(static_cast<std::size_t>(grid_.cell_count()), kNowhere);
    counts_.steps = counts_.steps.value_or(0);
    if (count_missed)
        counts_.missed_collisions = counts_.missed_collisions.value_or(0);
    else
        counts_.missed_collisions.reset();

    if (start.contacts) {
        for (const SavedContact& contact : *start.contacts) lasting_.push_back(meeting_of(contact));
    } else {  // who overlaps at the start, or touches: a step of no length
        move_all();
        search();
        lasting_.insert(lasting_.end(), contacts_.begin(), contacts_.end());
        contacts_.clear();
    }
    // The step before the present one, or an earlier one.
    step_index_ = std::max(0.0, std::floor(clock_.to_seconds(now_) / steps_.longest) - 1);
    if (bodies.accelerates_each() && !start.has_field)
        renew_field({});
    else
        schedule();
}

/// A contact as it was saved. Throws SnapshotError where it cannot be.
EmpiricalEngine::Meeting EmpiricalEngine::meeting_of(const SavedContact& c) const {
    const auto moves = [this](std::uint32_t body) {
        return body < bodies_.count && slot_of_[body] != kNowhere;
    };
    const bool is_side = c.partner >= bodies_.first_side();
    if (!moves(c.ball) || c.partner >= bodies_.first_side() + 4 ||
        (moves(c.partner) && c.partner <= c.ball) ||
        (is_side &&
         bodies_.physics.domain.boundary[Side(c.partner - bodies_.first_side()).axis] != Boundary::kWall))
        throw SnapshotError("holds a contact of bodies that cannot touch");
    const Pair pair{slot_of_[c.ball],
                    moves(c.partner) ? slot_of_[c.partner] : kNowhere,
                    c.partner,
                    {c.image_x, c.image_y}};
    if (!is_close(pair)) throw SnapshotError("holds a contact of bodies that are apart");
    return meeting_of(pair, 0);
}

/// Chooses the end of the next step.
void EmpiricalEngine::schedule() {
    if (size() == 0) return;
    if (std::isfinite(steps_.travel)) {
        next_ = clock_.after(now_, std::min(steps_.longest, travel_time()));
        if (next_ > now_) return;
        std::ostringstream what;
        what << "a step at time " << clock_.to_seconds(now_)
             << " is too short to tell: a ball is too fast for max_travel";
        throw std::runtime_error(what.str());
    }
    while (!(next_ != kNever && next_ > now_)) {
        step_index_ += 1;
        next_ = clock_.from_seconds(step_index_ * steps_.longest);
        if (next_ == kNever) return;
    }
}

/// The time in which the first of all balls has travelled as far as a step allows: d = v t + a t^2 / 2.
double EmpiricalEngine::travel_time() {
    const double d = steps_.travel;
    for_parts(size(), kGrain, [this, d](Part& part, std::size_t first, std::size_t last) {
        part.shortest = std::numeric_limits<double>::infinity();
        for (std::size_t i = first; i < last; ++i) {
            const auto slot = static_cast<std::uint32_t>(i);
            const double speed_squared = vx_[i] * vx_[i] + vy_[i] * vy_[i];
            const double pull = std::sqrt(length_squared(acceleration_of(slot)));
            const double sum = std::sqrt(speed_squared) + std::sqrt(speed_squared + 2 * pull * d);
            if (sum > 0) part.shortest = std::min(part.shortest, 2 * d / sum);
        }
    });
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < (size() + kGrain - 1) / kGrain; ++p)
        shortest = std::min(shortest, parts_[p].shortest);
    return shortest;
}

void EmpiricalEngine::advance_to(const Time& end, const Time& horizon) {
    for (;;) {
        const Time to = std::min(next_, horizon);
        if (!(to <= end) || !(to > now_) || size() == 0) return;
        step_to(to);
    }
}

void EmpiricalEngine::step_to(const Time& end) {
    duration_ = clock_.difference(end, now_);
    move_all();
    search();
    resolve_all();
    if (counts_missed_) count_missed();
    keep_lasting();
    settle_all();
    now_ = end;
    const std::uint64_t steps = counts_.steps.value_or(0);
    if (steps % kStepsOfOrder == 0) reorder();
    counts_.steps = steps + 1;
    schedule();
}

/// Every ball's end of the step, as if it met nobody, and the cells of the ends.
void EmpiricalEngine::move_all() {
    executor_.for_ranges(size(), kGrain, [this](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto slot = static_cast<std::uint32_t>(i);
            const Vec2 a = acceleration_of(slot);
            place_end(slot, {coordinate_at(x_[i], vx_[i], a.x(), duration_),
                             coordinate_at(y_[i], vy_[i], a.y(), duration_)});
        }
    });
    grid_.sort(wrapped_x_, wrapped_y_, is_large_, executor_);
}

void EmpiricalEngine::place_end(std::uint32_t slot, const Vec2& end) {
    // Beyond that the periods passed do not fit their number.
    constexpr double kMostPeriods = 1e9;
    const auto fits = [](const GridAxis& axis, double x) {
        return !axis.periodic() || std::abs(x - axis.min()) < kMostPeriods * axis.length();
    };
    if (!fits(bodies_.grid.x, end.x()) || !fits(bodies_.grid.y, end.y()))
        throw std::runtime_error(bodies_.ball_name(id_[slot]) +
                                 ": flies through more than a thousand million periods in one step");
    Periods away;
    wrapped_x_[slot] = bodies_.grid.x.wrapped(end.x(), away.x);
    wrapped_y_[slot] = bodies_.grid.y.wrapped(end.y(), away.y);
    if (!turns_.empty()) turns_[slot] = away;
}

/// Keeps of `lasting_` what still overlaps, as it will be seen from the next step.
void EmpiricalEngine::keep_lasting() {
    std::erase_if(lasting_, [this](const Meeting& m) {
        return stamp_of(m.pair.slot) != m.stamp || stamp_of(m.pair.other) != m.other_stamp;
    });
    for (Meeting& m : lasting_) {
        const Image turns = m.pair.other == kNowhere ? Image{} : turns_of(m.pair.other);
        m.pair.image = m.pair.image - turns_of(m.pair.slot) + turns;
        m.stamp = m.other_stamp = 0;
    }
}

/// Anchors every ball at the end of the step.
void EmpiricalEngine::settle_all() {
    executor_.for_ranges(size(), kGrain, [this](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto slot = static_cast<std::uint32_t>(i);
            const Motion<double> m = motion_from(slot, start_of(slot));
            const double rest = duration_ - start_of(slot);
            const Vec2 x = bodies_.held_position(position_at(m, rest), periods_[i]);
            const Vec2 v = bodies_.held_velocity(velocity_at(m, rest));
            x_[i] = x.x();
            y_[i] = x.y();
            vx_[i] = v.x();
            vy_[i] = v.y();
        }
    });
    for (const Touched& t : touched_) {
        touched_index_[t.slot] = kNowhere;
        if (t.cell >= 0) first_touched_[static_cast<std::size_t>(t.cell)] = kNowhere;
    }
    touched_.clear();
    legs_.clear();
    resolved_.clear();
}

/// Puts the balls in the order of the cells that they are in.
void EmpiricalEngine::reorder() {
    std::vector<std::uint32_t> old_of(grid_.numbers().begin(), grid_.numbers().end());
    old_of.insert(old_of.end(), large_.begin(), large_.end());
    const auto permute = [&old_of](auto& table) {
        if (table.empty()) return;
        auto ordered = table;
        for (std::size_t i = 0; i < old_of.size(); ++i) ordered[i] = table[old_of[i]];
        table = std::move(ordered);
    };
    const auto permute_all = [&permute](auto&... tables) { (permute(tables), ...); };
    permute_all(x_, y_, vx_, vy_, id_, periods_, acceleration_, radius_, last_collision_, is_large_);
    const auto renumber = [this](std::uint32_t& slot, std::uint32_t id) {
        if (slot != kNowhere) slot = slot_of_[id];
    };
    for (std::uint32_t i = 0; i < size(); ++i) slot_of_[id_[i]] = i;
    for (std::size_t n = 0; n < large_.size(); ++n) large_[n] = slot_of_[bodies_.large[n]];
    for (Meeting& m : lasting_) {
        const std::uint32_t first = m.lower == m.pair.partner ? m.higher : m.lower;
        renumber(m.pair.slot, first);
        renumber(m.pair.other, m.pair.partner);
    }
}

void EmpiricalEngine::renew_field(const Time& t) {
    if (size() == 0 || !bodies_.accelerates_each()) return;
    if (t != now_) throw std::logic_error("the field changes within a step");
    for (std::uint32_t i = 0; i < size(); ++i)
        acceleration_[i] = bodies_.acceleration_at(id_[i], {x_[i], y_[i]});
    schedule();
}

void EmpiricalEngine::visit_states(const Time& t, const VisitState& visit) const {
    executor_.for_ranges(size(), kGrain, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            Anchor anchor;
            anchor.x = x_[i];
            anchor.y = y_[i];
            anchor.vx = vx_[i];
            anchor.vy = vy_[i];
            anchor.time = now_;
            visit(id_[i],
                  state_at(bodies_, anchor, periods_[i], acceleration_of(static_cast<std::uint32_t>(i)), t));
        }
    });
}

void EmpiricalEngine::audit(std::vector<Violation>& found) const {
    for (std::uint32_t i = 0; i < size(); ++i) {
        const auto report = [&](const std::string& what) {
            found.push_back({bodies_.ball_name(id_[i]) + ": " + what});
        };
        if (!std::isfinite(x_[i] + y_[i] + vx_[i] + vy_[i])) report("state is not finite");
        if (slot_of_[id_[i]] != i) report("is not where its id says");
        if (is_touched(i)) report("is still within a step");
    }
    for (const Meeting& m : lasting_) {
        if (!is_close(m.pair))
            found.push_back({bodies_.ball_name(id_[m.pair.slot]) + ": is kept as overlapping body " +
                             std::to_string(m.pair.partner) + ", which is elsewhere"});
    }
    if (!(now_ < next_) && size() > 0) found.push_back({"the next step lies in the past"});
}

/// Whether two bodies are where they may be kept as overlapping at the end of the last step.
bool EmpiricalEngine::is_close(const Pair& pair) const {
    const auto place = [this](std::uint32_t slot) { return Vec2(x_[slot], y_[slot]); };
    const Vec2 centre = place(pair.slot);
    const Vec2 other = pair.other == kNowhere ? centre : place(pair.other);
    return touch(pair, centre, other).gap < radius_of(pair.slot);
}

void EmpiricalEngine::save(const Time&, Snapshot& snapshot) const {
    snapshot.method = "empirical";
    BallSaver saver(bodies_, snapshot);
    for (std::uint32_t i = 0; i < size(); ++i) {
        BallExtra extra;
        if (!last_collision_.empty()) extra.last_collision = last_collision_[i];
        if (!acceleration_.empty()) extra.acceleration = acceleration_[i];
        saver.save(id_[i], {x_[i], y_[i], vx_[i], vy_[i], now_, 0, 0, {}}, periods_[i], extra);
    }
    std::vector<SavedContact>& contacts = snapshot.contacts.emplace();
    for (const Meeting& m : lasting_)
        contacts.push_back({id_[m.pair.slot], m.pair.partner, m.pair.image.x, m.pair.image.y});
    std::ranges::sort(contacts);
}

void EmpiricalEngine::visit_flights(const Stop&, const Time&, const VisitFlights&) const {
    throw std::logic_error("the empirical method knows no flights from event to event");
}

void EmpiricalEngine::follow(Follower follower) {
    if (follower) visit_flights({}, {}, {});
}

std::unique_ptr<Engine> make_empirical_engine(const Bodies& bodies, const EngineStart& start,
                                              const Executor& executor, bool count_missed) {
    return std::make_unique<EmpiricalEngine>(bodies, start, executor, count_missed);
}

}  // namespace carom
