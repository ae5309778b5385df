// Edits of a running world: another cast, that goes on from where the bodies are. A ball that is not edited
// keeps its anchor, so that nothing of its way changes but by what it meets.
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include <carom/broadphase/overlap.hpp>

#include "fault.hpp"
#include "hash.hpp"
#include "physics.hpp"
#include "scene_hash.hpp"
#include "world_state.hpp"

namespace carom {
namespace {

constexpr std::uint32_t kNew = std::numeric_limits<std::uint32_t>::max();

/// Someone of the next cast.
template <class Body>
struct Member {
    std::uint32_t id = 0;
    std::uint32_t was = kNew;  // its index until now
    bool is_changed = false;   // in anything
    bool is_edited = false;    // its way so far says nothing of its future
    bool is_placed = false;    // it is new, elsewhere, or meets others than before, and may overlap
    Body body;
};

template <class Body>
using Members = std::vector<Member<Body>>;

/// The members by id, as they are before anything is added or removed.
template <class Body>
Member<Body>& find(Members<Body>& members, std::uint32_t id, const char* list) {
    const auto at = std::ranges::lower_bound(members, id, {}, &Member<Body>::id);
    if (at == members.end() || at->id != id)
        throw std::out_of_range(std::string(list) + "[" + std::to_string(id) + "]: is not there");
    return *at;
}

template <class Body>
void remove(Members<Body>& members, std::vector<std::uint32_t> ids, const char* list) {
    std::ranges::sort(ids);
    for (std::size_t k = 0; k < ids.size(); ++k) {
        find(members, ids[k], list);
        if (k > 0 && ids[k] == ids[k - 1])
            throw std::invalid_argument(std::string(list) + "[" + std::to_string(ids[k]) +
                                        "]: is removed twice");
    }
    std::erase_if(members, [&ids](const Member<Body>& m) { return std::ranges::binary_search(ids, m.id); });
}

/// Gives what is added the least ids that nobody had before this batch.
template <class Body>
std::vector<std::uint32_t> add(Members<Body>& members, const std::vector<std::uint32_t>& taken,
                               const std::vector<Body>& added) {
    std::vector<std::uint32_t> ids;
    auto next = taken.begin();
    std::uint32_t id = 0;
    for (const Body& body : added) {
        for (; next != taken.end() && *next == id; ++next) ++id;
        ids.push_back(id);
        members.push_back({id++, kNew, true, true, true, body});
    }
    std::ranges::sort(members, {}, &Member<Body>::id);
    return ids;
}

template <class Body>
std::vector<std::uint32_t> ids_of(const Members<Body>& members) {
    std::vector<std::uint32_t> ids;
    ids.reserve(members.size());
    for (const Member<Body>& m : members) ids.push_back(m.id);
    return ids;
}

/// Empty where every id is the index.
std::vector<std::uint32_t> needed(std::vector<std::uint32_t> ids) {
    return ids.empty() || ids.back() + 1 == ids.size() ? std::vector<std::uint32_t>() : std::move(ids);
}

template <class Body>
std::vector<Body> bodies_of(const Members<Body>& members) {
    std::vector<Body> bodies;
    bodies.reserve(members.size());
    for (const Member<Body>& m : members) bodies.push_back(m.body);
    return bodies;
}

void change(Member<Ball>& m, const BallChange& c) {
    m.is_placed = m.is_placed || c.position || c.radius || c.filter;
    m.is_edited = m.is_edited || m.is_placed || c.velocity || c.acceleration;
    if (c.position) m.body.position = *c.position;
    if (c.velocity) m.body.velocity = *c.velocity;
    if (c.acceleration) m.body.acceleration = *c.acceleration;
    if (c.radius) m.body.radius = *c.radius;
    if (c.mass) m.body.mass = *c.mass;
    if (c.restitution) m.body.restitution = *c.restitution;
    if (c.filter) m.body.filter = *c.filter;
    m.is_changed = true;
}

/// What is there may have come, by rounding, to where no scene may start: only what is placed has to fit.
void check_edited(const Members<Ball>& balls, const Members<Wall>& walls, const Edits& edits,
                  const Scene& rules) {
    Scene anywhere;
    anywhere.precision = rules.precision;
    Scene inside = anywhere;
    inside.domain = rules.domain;
    for (const Member<Ball>& m : balls) {
        if (!m.is_changed) continue;
        check(m.body, m.is_placed ? inside : anywhere, m.id);
        for (int axis = 0; inside.domain && axis < 2; ++axis) {
            const double width = inside.domain->box.max[axis] - inside.domain->box.min[axis];
            if (inside.domain->boundary[axis] == Boundary::kPeriodic && 2 * m.body.radius > width)
                throw SceneError("balls[" + std::to_string(m.id) + "].radius",
                                 "must be at most half the periodic box's width, is " + shown(m.body.radius));
        }
    }
    for (const Member<Wall>& m : walls)
        if (m.is_changed) check(m.body, inside, m.id);
    for (std::size_t k = 0; edits.attractors && k < edits.attractors->size(); ++k)
        check((*edits.attractors)[k], k);
    if (edits.gravity) check_gravity(*edits.gravity);
}

/// The scales of time and virial are the scene's for ever; losses that come with a body bring the contact
/// time that a scene with them would have.
Physics physics_of(const Physics& before, const Scene& rules, const std::vector<Ball>& balls) {
    const Physics derived = derive_physics(rules, balls);
    Physics p = before;
    p.gravity = rules.gravity;
    p.loses_energy = derived.loses_energy;
    p.empirical = derived.empirical;
    if (p.contact_time == 0) p.contact_time = derived.contact_time;
    if (p.rest_time == 0 || (before.contact_time == 0 && p.contact_time > 0)) p.rest_time = derived.rest_time;
    return p;
}

/// Takes the moving balls of one cast, in order, into a snapshot of another's.
class Carrier {
 public:
    Carrier(Snapshot from, const Bodies& before, const Bodies& after, const Time& now)
        : from_(std::move(from)), before_(before), after_(after), now_(now) {
        to_.time = from_.time;
        to_.counts = from_.counts;
        to_.virial = from_.virial;
        std::uint32_t rank = 0;
        for (std::uint32_t i = 0; i < before.count; ++i) ranks_.push_back(before.fixes(i) ? rank : rank++);
    }

    /// A ball that goes on as it is.
    void keep(std::uint32_t was) {
        const std::uint32_t k = ranks_[was];
        push(from_.anchors[k], last_collision(was),
             from_.accelerations.empty() ? before_.physics.gravity : from_.accelerations[k]);
    }
    /// A ball that starts here and now; `periods` is how many it has passed so far.
    void start(std::uint32_t index, const Ball& b, Periods periods, const Time& last_collision) {
        const Vec2 position = after_.held_position(b.position, periods);
        push({position, after_.held_velocity(b.velocity), now_, periods.x, periods.y}, last_collision,
             after_.acceleration_at(index, position));
    }
    /// One that was there.
    void start_anew(std::uint32_t index, std::uint32_t was, const Ball& b, const BallState& s) {
        const auto passed = [](const GridAxis& axis, double way) {
            return axis.periodic() ? static_cast<std::int32_t>(std::lround(way / axis.length())) : 0;
        };
        const Vec2 way = s.unwrapped - s.position;
        start(index, b, {passed(after_.grid.x, way.x()), passed(after_.grid.y, way.y())},
              last_collision(was));
    }
    [[nodiscard]] Snapshot take() { return std::move(to_); }

 private:
    [[nodiscard]] Time last_collision(std::uint32_t was) const {
        return from_.last_collisions.empty() ? BallExtra().last_collision
                                             : from_.last_collisions[ranks_[was]];
    }
    void push(const SavedAnchor& anchor, const Time& last_collision, const Vec2& acceleration) {
        to_.anchors.push_back(anchor);
        if (after_.physics.contact_time > 0) to_.last_collisions.push_back(last_collision);
        if (after_.accelerates_each()) to_.accelerations.push_back(acceleration);
    }

    Snapshot from_;
    Snapshot to_;
    const Bodies& before_;
    const Bodies& after_;
    Time now_;
    std::vector<std::uint32_t> ranks_;  // among the moving balls, by index
};

/// How often the attractors' field has been renewed by then.
std::uint64_t updates_until(double seconds, double interval) {
    auto updates = static_cast<std::uint64_t>(seconds / interval);
    while (double(updates) * interval > seconds) --updates;
    while (double(updates + 1) * interval <= seconds) ++updates;
    return updates;
}

/// Whether edits change no more than where balls are and how they move.
bool are_new_starts(const Edits& edits) {
    const auto is_start = [](const BallChange& c) {
        return !c.acceleration && !c.radius && !c.mass && !c.restitution && !c.filter;
    };
    return edits.removed_balls.empty() && edits.added_balls.empty() && edits.removed_walls.empty() &&
           edits.added_walls.empty() && !edits.attractors && !edits.gravity &&
           std::ranges::all_of(edits.changed_balls, is_start);
}

}  // namespace

bool World::State::start_anew(const Edits& edits) {
    if (!are_new_starts(edits) || has_stopped_midway_) return false;
    // The scene's beginning tells the times of contact and rest; where all is at rest then, or no force is
    // felt, it may tell none, and they follow from what moves later.
    const Physics& physics = bodies().physics;
    const bool has_no_contact_time =
        physics.loses_energy && physics.contact_time == 0 && !cast->rules.contact_time;
    const bool has_no_rest_time = physics.rest_time == 0 && bodies().acceleration() != Acceleration::kNone;
    if (physics.empirical || has_no_contact_time || has_no_rest_time || cast->rules.allows_overlap)
        return false;
    std::map<std::uint32_t, BallChange> changes;  // by index; of two of one ball the later one counts
    for (const BallChange& c : edits.changed_balls) {
        const std::uint32_t i = index_of_ball(c.id);
        if (bodies().fixes(i)) return false;
        if (!c.position && !c.velocity) continue;
        BallChange& change = changes.try_emplace(i, BallChange{.id = c.id}).first->second;
        if (c.position) change.position = c.position;
        if (c.velocity) change.velocity = c.velocity;
    }
    // A pass over all balls, which a kick alone has no need of.
    const bool needs_states =
        !bodies().attractors.empty() || std::ranges::any_of(changes, [](const auto& change) {
            return change.second.position || !change.second.velocity;
        });
    Members<Ball> members;
    std::vector<NewStart> starts;
    for (const auto& [i, c] : changes) {
        Member<Ball>& m = members.emplace_back();
        m = {c.id, i, false, false, false, ball(i, needs_states ? states()[i] : BallState{})};
        change(m, c);
    }
    check_edited(members, {}, edits, cast->rules);
    for (const Member<Ball>& m : members)  // may be refused as well, and nothing is half done
        static_cast<void>(bodies().acceleration_at(m.was, m.body.position));
    const bool has_moves = std::ranges::any_of(members, &Member<Ball>::is_placed);
    if (has_moves) {
        std::vector<Ball> all = balls();
        Selection placed{std::vector<std::uint8_t>(size(), 0), {}, bodies().ball_ids, bodies().wall_ids};
        for (const Member<Ball>& m : members) {
            all[m.was] = m.body;
            placed.balls[m.was] = m.is_placed ? 1 : 0;
        }
        check_overlaps(all, cast->rules, placed);
    }
    for (const Member<Ball>& m : members) {
        BallChange& c = changes.at(m.was);
        if (c.position && physics.in_float) c.position = rounded_to_float(*c.position);
        starts.push_back({m.was, c.position, c.velocity});
    }
    if (!engine->start_anew(now, starts)) return false;

    is_edited = true;
    Hash edited{hash};
    for (const Member<Ball>& m : members) edited << std::uint64_t{m.id} << m.body.position << m.body.velocity;
    hash = (edited << seconds).value;
    if (has_moves) places_.reset();
    for (const NewStart& start : starts)
        if (is_read_) states_[start.ball] = start.state;
    if (watch_) watch_->take(*engine, {now}, sensing);
    return true;
}

Added World::State::apply(const Edits& edits) {
    const Telling telling(*this);
    if (start_anew(edits)) return {};
    // A step of the empirical method ends where edits take place. Refused ones must end none, so another
    // engine does it first.
    std::unique_ptr<Engine> ahead;
    std::vector<BallState> states_ahead;
    if (bodies().physics.empirical) {
        ahead = make_from(*cast, snapshot());
        ahead->advance_to(now, now);
        read(*ahead, states_ahead);
    }
    Members<Ball> balls;
    balls.reserve(size() + edits.added_balls.size());
    const std::vector<BallState>& all = ahead ? states_ahead : states();
    for (std::uint32_t i = 0; i < size(); ++i)
        balls.push_back({bodies().ball_id(i), i, false, false, false, ball(i, all[i])});
    Members<Wall> walls;
    for (std::uint32_t w = 0; w < bodies().walls.size(); ++w)
        walls.push_back({bodies().wall_id(w), w, false, false, false, bodies().walls[w]});

    const std::vector<std::uint32_t> taken_balls = ids_of(balls);
    const std::vector<std::uint32_t> taken_walls = ids_of(walls);
    for (const BallChange& c : edits.changed_balls) change(find(balls, c.id, "balls"), c);
    remove(balls, edits.removed_balls, "balls");
    remove(walls, edits.removed_walls, "walls");
    Added added;
    added.balls = add(balls, taken_balls, edits.added_balls);
    added.walls = add(walls, taken_walls, edits.added_walls);

    Scene rules = cast->rules;
    rules.walls = bodies_of(walls);
    if (edits.attractors) rules.attractors = *edits.attractors;
    if (edits.gravity) rules.gravity = *edits.gravity;
    check_edited(balls, walls, edits, rules);
    const auto is_placed = [](const auto& member) { return member.is_placed; };
    if (!rules.allows_overlap &&
        (std::ranges::any_of(balls, is_placed) || std::ranges::any_of(walls, is_placed))) {
        Selection selected{{}, {}, ids_of(balls), ids_of(walls)};
        for (const Member<Ball>& m : balls) selected.balls.push_back(m.is_placed ? 1 : 0);
        for (const Member<Wall>& m : walls) selected.walls.push_back(m.is_placed ? 1 : 0);
        check_overlaps(bodies_of(balls), rules, selected);
    }
    // As a scene's are: what is static gets no other chance.
    if (rules.precision == Precision::kFloat)
        for (Member<Ball>& m : balls)
            if (m.is_placed) round_to_float(m.body);
    const std::vector<Ball> now_there = bodies_of(balls);

    const Physics physics = physics_of(bodies().physics, rules, now_there);
    auto next = std::make_shared<Cast>(rules, physics, now_there, wanted.cell_size);
    next->bodies.ball_ids = needed(ids_of(balls));
    next->bodies.wall_ids = needed(ids_of(walls));
    next->deepest_overlap = std::max(next->deepest_overlap, cast->deepest_overlap);
    next->scene_hash = cast->scene_hash;
    // What is hit where it stands is hit by flights that start before it stood there, and other forces bend
    // all flights: then all balls start anew.
    const auto is_new_obstacle = [](const Member<Ball>& m) { return m.is_placed && m.body.is_static; };
    const bool walls_are_new = !edits.added_walls.empty() && !is_active(Fault::kOldFlights);
    const bool all_start_anew =
        edits.attractors || edits.gravity || walls_are_new || std::ranges::any_of(balls, is_new_obstacle);
    Carrier carrier(snapshot_of(ahead ? *ahead : *engine), bodies(), next->bodies, now);
    for (std::uint32_t i = 0; i < balls.size(); ++i) {
        const Member<Ball>& m = balls[i];
        if (m.body.is_static) continue;
        if (m.was == kNew)
            carrier.start(i, m.body, {}, BallExtra().last_collision);
        else if (all_start_anew || m.is_edited)
            carrier.start_anew(i, m.was, m.body, all[m.was]);
        else
            carrier.keep(m.was);
    }
    Snapshot s = carrier.take();
    s.scene_hash = (Hash{hash} << carom::scene_hash(rules, physics, now_there, executor) << seconds).value;
    s.edited = next;
    s.field_updates = rules.attractors.empty() ? 0 : updates_until(seconds, rules.field_interval);
    std::unique_ptr<Engine> made = make_from(*next, s);
    if (ahead) {  // and whoever listens is told
        is_moving_ = true;
        engine->advance_to(now, now);
        is_moving_ = false;
    }
    const std::vector<BallState> before = watch_ ? all : std::vector<BallState>();
    const std::shared_ptr<const Cast> past = cast;  // until the watch has gone on
    continue_with(next, std::move(made), s);
    for (const std::uint32_t id : edits.removed_balls)
        if (id < user_data.size()) user_data[id] = 0;
    if (watch_) watch_->go_on_with(bodies(), *engine, now, before, sensing);
    return added;
}

}  // namespace carom
