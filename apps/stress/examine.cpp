// The stretches of a trial, what is looked at after each, and the worlds that are compared.
#include "examine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <carom/parallel/world.hpp>

#include "draw.hpp"
#include "hash.hpp"
#include "overlaps.hpp"
#include "reference_engine.hpp"
#include "replay.hpp"

namespace carom::stress {
namespace {

constexpr int kStretches = 5;
constexpr std::uint64_t kMostCollisions = 100'000;
constexpr std::size_t kEventsOfReference = 300;
// All pairs at each event.
constexpr std::size_t kMostBallsOfReference = 64;
constexpr double kMostPeriodsOfReference = 6;

/// Something that does not hold.
struct Failure {
    std::string check;
    std::string detail;
};

struct EnoughCollisions {};

/// What the collisions until now come to.
struct Seen {
    Hash events;
    std::vector<std::uint32_t> by_ball;  ///< how many of them each ball had
};

/// A world and what is seen of it.
class Watched {
 public:
    Watched(const std::string& name, World world) : name_(name), world_(std::move(world)) {
        seen_ = std::make_unique<Seen>();
        seen_->by_ball.resize(world_.ball_count());
        listen(nullptr);
    }
    /// Hands each collision to `listener` besides.
    void listen(std::function<void(const Collision&)> listener) {
        world_.on_collision([seen = seen_.get(), listener = std::move(listener)](const Collision& c) {
            seen->events << c.time << std::uint64_t(c.kind) << std::uint64_t{c.i} << std::uint64_t{c.j}
                         << c.point << c.normal << c.impulse;
            ++seen->by_ball[c.i];
            if (c.kind == CollisionKind::kBall) ++seen->by_ball[c.j];
            if (listener) listener(c);
        });
    }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] World& world() { return world_; }
    [[nodiscard]] const Seen& seen() const { return *seen_; }
    void set_seen(const Seen& seen) { *seen_ = seen; }

 private:
    std::string name_;
    World world_;
    std::unique_ptr<Seen> seen_;  // its address stays when this is moved
};

class Examination {
 public:
    explicit Examination(const Trial& trial)
        : scene_(trial.scene), threads_(trial.threads), draw_(trial.seed) {
        double end = 0;
        for (double& stop : stops_) stop = end += draw_.uniform(0.05, 1);
        for (double& stop : stops_) stop *= scene_.until / end;
        stops_.back() = scene_.until;
    }

    Verdict run();

 private:
    void run_plain(Verdict& verdict);
    void follow_reference();
    void run_other(const std::string& name, const WorldOptions& options, bool in_frames, bool resumes);
    void restore_and_repeat(Watched& plain, const Snapshot& snapshot);
    void check_state(Watched& watched);
    void expect_same(Watched& watched, std::size_t stop);
    void advance(Watched& watched, double stop, bool in_frames);
    [[nodiscard]] WorldOptions drawn_options();

    /// What a world shows at a stop.
    struct Shown {
        std::uint64_t hash, events, balls, walls;
        double virial, energy;
        bool operator==(const Shown&) const = default;
    };
    [[nodiscard]] static Shown shown(Watched& watched);

    Scene scene_;
    int threads_;
    Draw draw_;
    std::array<double, kStretches> stops_{};
    std::size_t reached_ = 0;  ///< stops of the plain run
    std::vector<Shown> plain_;
    std::vector<Collision> first_events_;
    std::optional<Snapshot> snapshot_;
    Seen seen_at_snapshot_;
    std::size_t snapshot_stop_ = 0;
};

Examination::Shown Examination::shown(Watched& w) {
    const Counts counts = w.world().counts();
    return {w.world().state_hash(), w.seen().events.value, counts.ball_collisions,
            counts.wall_collisions, w.world().virial(),    w.world().energy()};
}

WorldOptions Examination::drawn_options() {
    WorldOptions options;
    options.threads = 1 + static_cast<int>(draw_.below(static_cast<std::size_t>(threads_)));
    double diameter = 0;
    for (const Ball& b : scene_.balls)
        if (!b.is_static) diameter = std::max(diameter, 2 * b.radius);
    if (draw_.one_in(2)) options.cell_size = diameter * draw_.uniform(1.02, 4);
    options.domains = 1 + static_cast<int>(draw_.below(10));
    options.halo = static_cast<int>(draw_.below(7));
    return options;
}

void Examination::check_state(Watched& w) {
    if (const std::vector<Violation> found = w.world().validate(); !found.empty())
        throw Failure{"validate", w.name() + ": " + found.front().what};
    double events = 0;
    for (const std::uint32_t of_ball : w.seen().by_ball) events = std::max<double>(events, of_ball);
    if (!scene_.attractors.empty()) events += w.world().time() / scene_.field_interval;
    if (const std::string fault = find_misplaced(scene_, w.world(), events); !fault.empty())
        throw Failure{"overlap", w.name() + ": " + fault};
}

/// The run that all others are compared with: one thread, one domain, each stretch at once.
void Examination::run_plain(Verdict& verdict) {
    Watched plain("plain", World(scene_, {.threads = 1, .domains = 1}));
    Replay replay(scene_, plain.world());
    std::uint64_t count = 0;
    plain.listen([&](const Collision& c) {
        if (++count > kMostCollisions) throw EnoughCollisions{};
        if (first_events_.size() < kEventsOfReference) first_events_.push_back(c);
        replay.take(c);
    });
    snapshot_stop_ = draw_.below(kStretches);
    try {
        for (const double stop : stops_) {
            plain.world().advance_to(stop);
            verdict.time = stop;
            replay.compare(plain.world());
            if (!replay.fault().empty()) throw Failure{"physics", replay.fault()};
            check_state(plain);
            plain_.push_back(shown(plain));
            if (reached_ == snapshot_stop_ && scene_.method == Method::kEvent) {
                snapshot_ = plain.world().snapshot();
                seen_at_snapshot_ = plain.seen();
            }
            ++reached_;
        }
    } catch (const EnoughCollisions&) {
        verdict.is_cut = true;
    } catch (const std::runtime_error& error) {
        verdict.is_refused = true;
        verdict.detail = error.what();
    }
    verdict.collisions = count;
    if (!replay.fault().empty()) throw Failure{"physics", replay.fault()};
    if (reached_ == kStretches && snapshot_) restore_and_repeat(plain, *snapshot_);
}

void Examination::restore_and_repeat(Watched& plain, const Snapshot& snapshot) {
    plain.listen(nullptr);
    plain.world().restore(snapshot);
    plain.set_seen(seen_at_snapshot_);
    for (std::size_t k = snapshot_stop_; k < reached_; ++k) {
        plain.world().advance_to(stops_[k]);
        if (shown(plain) != plain_[k])
            throw Failure{"restore", fmt::format("restored at time {}, another state or list of collisions "
                                                 "at time {}",
                                                 stops_[snapshot_stop_], stops_[k])};
    }
}

/// Periods that two balls may pass between two events of theirs, seen from each other, in all of the time.
double periods_passed(const Scene& scene) {
    double speed = 0;
    double pull = 0;
    for (const Ball& b : scene.balls) {
        speed = std::max(speed, std::sqrt(length_squared<double>(b.velocity)));
        pull = std::max(pull, std::sqrt(length_squared<double>(b.acceleration + scene.gravity)));
    }
    double width = std::numeric_limits<double>::infinity();
    for (int axis = 0; scene.domain && axis < 2; ++axis)
        if (scene.domain->boundary[std::size_t(axis)] == Boundary::kPeriodic)
            width = std::min(width, scene.domain->box.max[axis] - scene.domain->box.min[axis]);
    // A light ball may leave a heavy one with twice its speed.
    return 2 * (2 * speed + pull * scene.until) * scene.until / width;
}

/// Event by event against the engine that looks at all pairs.
void Examination::follow_reference() {
    if (!scene_.attractors.empty() || scene_.method != Method::kEvent || reached_ == 0) return;
    if (scene_.balls.size() > kMostBallsOfReference || scene_.allows_overlap) return;
    const double periods = periods_passed(scene_);
    if (periods > kMostPeriodsOfReference) return;
    BruteForceRules rules = rules_of(scene_);
    rules.images = 1 + static_cast<int>(periods);
    BruteForce reference(rules, scene_.balls, scene_.walls);
    const std::size_t balls = scene_.balls.size();
    for (std::size_t k = 0; k < kEventsOfReference && !reference.finished(); ++k) {
        const BruteForceEvent expected = reference.next();
        if (expected.time > stops_[reached_ - 1]) return;
        if (k >= first_events_.size())
            throw Failure{"reference", fmt::format("event {} at time {} between {} and {} is missed", k,
                                                   expected.time, expected.i, expected.j)};
        const Collision& got = first_events_[k];
        const std::size_t j = got.kind == CollisionKind::kBall ? got.j : balls + got.j;
        const std::size_t lower = std::min<std::size_t>(got.i, j);
        const std::size_t higher = std::max<std::size_t>(got.i, j);
        if (got.time == expected.time && lower == expected.i && higher == expected.j) continue;
        throw Failure{"reference",
                      fmt::format("event {} is at time {} between {} and {}, must be at {} between {} and {}",
                                  k, got.time, lower, higher, expected.time, expected.i, expected.j)};
    }
}

/// To the stop at once, or in frames of any length, read now and then.
void Examination::advance(Watched& w, double stop, bool in_frames) {
    if (in_frames) {
        const double from = w.world().time();
        std::vector<double> frames(draw_.below(12));
        for (double& f : frames) f = from + (stop - from) * draw_.uniform(0, 1);
        std::ranges::sort(frames);
        for (const double f : frames) {
            w.world().advance_to(f);
            if (draw_.one_in(3)) check_state(w);
        }
    }
    w.world().advance_to(stop);
}

void Examination::expect_same(Watched& w, std::size_t stop) {
    const Shown got = shown(w);
    const Shown& expected = plain_[stop];
    if (got == expected) return;
    const char* what = got.hash != expected.hash       ? "state"
                       : got.balls != expected.balls   ? "number of ball collisions"
                       : got.walls != expected.walls   ? "number of wall collisions"
                       : got.events != expected.events ? "list of collisions"
                       : got.virial != expected.virial ? "virial"
                                                       : "energy";
    throw Failure{"same bits", fmt::format("{}: another {} at time {}", w.name(), what, stops_[stop])};
}

void Examination::run_other(const std::string& kind, const WorldOptions& options, bool in_frames,
                            bool resumes) {
    const std::string name = fmt::format("{} (threads {}, domains {}, halo {}, cell size {})", kind,
                                         options.threads, options.domains, options.halo, options.cell_size);
    std::size_t next = 0;
    std::optional<Watched> watched;
    if (resumes && snapshot_) {
        watched.emplace(name, World(scene_, options, *snapshot_));
        watched->set_seen(seen_at_snapshot_);
        next = snapshot_stop_;
    } else {
        watched.emplace(name, World(scene_, options));
    }
    for (; next < reached_; ++next) {
        advance(*watched, stops_[next], in_frames);
        check_state(*watched);
        expect_same(*watched, next);
    }
}

Verdict Examination::run() {
    Verdict verdict;
    try {
        run_plain(verdict);
        follow_reference();
        run_other("in frames", drawn_options(), true, false);
        run_other("at once", drawn_options(), false, false);
        if (snapshot_) run_other("resumed", drawn_options(), draw_.one_in(2), true);
    } catch (const Failure& failure) {
        verdict.check = failure.check;
        verdict.detail = failure.detail;
    } catch (const SceneError& error) {
        verdict.check = "refused";
        verdict.detail = error.what();
    } catch (const std::exception& error) {
        verdict.check = "exception";
        verdict.detail = error.what();
    }
    return verdict;
}

}  // namespace

Verdict examine(const Trial& trial) {
    return Examination(trial).run();
}

}  // namespace carom::stress
