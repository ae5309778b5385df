#include <carom/trade/advice.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <carom/parallel/world.hpp>
#include <carom/trade/clock.hpp>
#include <carom/trade/settings.hpp>

namespace carom::trade {
namespace {

constexpr double kCollisions = 2;             // a ball's, in the stretch
constexpr double kShareOfARun = 1. / 40;      // of the time, for one run of the event method at most
constexpr double kShareOfReference = 1. / 3;  // of the time
constexpr double kPartOfReference = 1. / 4;   // of the error, that the reference may be uncertain by
constexpr int kMostHalvings = 8;              // of the field's interval
constexpr double kTooSlow = 10;               // times the fastest that keeps: not worth the run's end
constexpr double kClearlyFaster = 0.95;       // of the event method's time
constexpr double kFirstSlice = 1e-6;          // of the scene, on the way to the stretch's end
constexpr double kSlowGrowth = 1. / 16;       // of slices, once collisions come
constexpr double kFastGrowth = 1. / 4;
// A contact found late by the tolerance moves what follows, and within two collisions in a dilute gas that
// grows a thousandfold: 1e-5 of the error leaves room.
constexpr double kPartOfTolerance = 1e-5;
constexpr double kLeastTolerance = 1e-11;  // of the smallest radius: rounding of places is not far below

double speed_of(const World& world, const Scene& scene) {
    const PlaneVectors velocities = world.velocities();
    double squares = 0;
    for (const Vec2& v : velocities) squares += length_squared(v);
    return std::sqrt(squares / moving_balls(scene));
}

double collisions_of(const Counts& counts) {
    return static_cast<double>(2 * counts.ball_collisions + counts.wall_collisions);
}

/// As it is written on a command line: few digits, not above the value, so that the last of many steps does
/// not end after the scene.
double rounded_down(double value) {
    const double unit = std::pow(10, std::floor(std::log10(value)) - 8);
    return std::stod(fmt::format("{:.9g}", std::floor(value / unit) * unit));
}

class Adviser {
 public:
    Adviser(const Scene& scene, const AdviceOptions& options) : scene_(scene), options_(options) {
        scene_.method = Method::kEvent;
        scene_.precision = Precision::kDouble;
        scene_.step.reset();
        scene_.max_travel.reset();
        scene_.tolerance.reset();
    }

    Advice advise() {
        find_stretch();
        make_reference();
        if (!events_.empty()) {
            judge_events();
            try_rarer_fields();
            try_steps();
            try_precision();
        }
        choose();
        return std::move(advice_);
    }

 private:
    /// A run of the event method, and how it is called.
    struct EventRun {
        std::string name;
        Scene scene;
        Trace trace;
        double seconds = 0;  ///< that it took, all in all
    };

    bool has_time() {
        const bool has = seconds_since(start_) < options_.seconds && options_.goes_on();
        if (!has) advice_.is_cut_short = true;
        return has;
    }

    void find_stretch();
    void make_reference();
    void judge_events();
    void try_rarer_fields();
    void try_precision();
    void try_steps();
    bool try_ladder(const Scene& scene);
    /// What came of it; nothing where there was no time for it.
    const Trial* try_one(const std::string& name, const Scene& scene);
    void judge(Trial& trial, const Trace& t) const;
    void time(Trial& trial);
    void choose();
    [[nodiscard]] double best_time() const;
    [[nodiscard]] std::string with_field(const std::string& name, const Scene& scene) const;

    Scene scene_;
    const AdviceOptions& options_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    Course course_;
    double speed_ = 0;              ///< largest root mean square on the stretch
    std::vector<EventRun> events_;  ///< the field renewed ever more often; the last is the reference
    Advice advice_;
};

// By slices that begin very short and grow: a scene may be over in a millionth of its time, or wait.
void Adviser::find_stretch() {
    options_.on_trial("event");
    World world(scene_, {.threads = options_.threads});
    const double balls = moving_balls(scene_);
    double seconds = 0;
    double slice = kFirstSlice * scene_.until;
    while (world.time() < scene_.until && collisions_of(world.counts()) < kCollisions * balls &&
           options_.goes_on() && seconds < kShareOfARun * options_.seconds) {
        const auto begin = std::chrono::steady_clock::now();
        world.advance_to(std::min(world.time() + slice, scene_.until));
        seconds += seconds_since(begin);
        speed_ = std::max(speed_, speed_of(world, scene_));
        const double growth =
            collisions_of(world.counts()) < kCollisions * balls / 8 ? kFastGrowth : kSlowGrowth;
        slice = std::max(slice, growth * world.time());
    }
    // A whole number of stretches, and so of steps, makes the scene.
    course_ = {.stretch = scene_.until / std::ceil(scene_.until / world.time() * (1 - 1e-12)),
               .is_detailed = false};
    advice_.until = course_.stretch;
}

// A field held constant is an error of the first order in its interval: what changes with the interval
// halved is what the better one is still wrong by.
void Adviser::make_reference() {
    Scene scene = scene_;
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
        const std::string name = with_field("event", scene);
        options_.on_trial(name);
        const auto begin = std::chrono::steady_clock::now();
        Trace t = trace(scene, course_, {.threads = options_.threads, .goes_on = options_.goes_on});
        if (!t.is_whole) return;
        const double seconds = seconds_since(begin);
        events_.push_back({name, scene, std::move(t), seconds});
        if (scene_.attractors.empty()) return;
        if (halvings > 0) {
            const Trace& rougher = events_.end()[-2].trace;
            advice_.reference_error = errors_of(scene_, course_, events_.back().trace, rougher).largest();
            if (advice_.reference_error <= kPartOfReference * options_.error) return;
        }
        if (seconds_since(start_) + 2 * seconds > kShareOfReference * options_.seconds) return;
        scene.field_interval /= 2;
    }
}

void Adviser::judge(Trial& trial, const Trace& t) const {
    trial.errors = errors_of(scene_, course_, events_.back().trace, t);
    trial.error = trial.errors->largest() + advice_.reference_error;
    trial.keeps = trial.error <= options_.error;
}

void Adviser::time(Trial& trial) {
    trial.time = time_ratio(trial.scene, scene_, course_.stretch,
                            {.threads = options_.threads,
                             .enough_seconds = kShareOfARun * options_.seconds,
                             .goes_on = [this] { return has_time(); }});
}

void Adviser::judge_events() {
    const Trace& reference = events_.back().trace;
    advice_.collisions_a_ball = collisions_of(reference.counts) / moving_balls(scene_);
    advice_.compared = matching_of(scene_, course_, reference, reference).compared;
    for (const EventRun& run : events_) {
        Trial trial{run.name, run.scene, {}, {}, 0, false};
        judge(trial, run.trace);
        const double ratio = run.seconds / events_.front().seconds;
        trial.time = TimeRatio{ratio, ratio, ratio, 1, events_.front().seconds};
        // Once is enough for what takes long.
        if (&run != &events_.front() && run.seconds < kShareOfARun * options_.seconds && has_time())
            time(trial);
        advice_.trials.push_back(std::move(trial));
    }
}

void Adviser::try_rarer_fields() {
    if (scene_.attractors.empty() || !advice_.trials.front().keeps) return;
    Scene scene = scene_;
    const Trial* trial = &advice_.trials.front();
    for (int doublings = 0; trial != nullptr && trial->keeps && doublings < kMostHalvings; ++doublings) {
        scene.field_interval *= 2;
        trial = try_one(with_field("event", scene), scene);
    }
}

void Adviser::try_precision() {
    Scene scene = scene_;
    scene.precision = Precision::kFloat;
    try_one("event, float", scene);
}

// At the rarest renewal of the field that keeps the error by itself, and where that leaves steps no room, at
// twice as many. Where none keeps it, at the most frequent one: it may be the better way all the same.
void Adviser::try_steps() {
    Scene scene = scene_;
    double rarest = 0;
    for (const Trial& t : advice_.trials)
        if (t.keeps && t.scene.precision == Precision::kDouble)
            rarest = std::max(rarest, t.scene.field_interval);
    if (!(speed_ > 0) || !scene_.sensors.empty()) return;  // the empirical method knows no sensors
    scene.field_interval = rarest > 0 ? rarest : events_.back().scene.field_interval;
    if (try_ladder(scene) || rarest == 0 || scene_.attractors.empty()) return;
    scene.field_interval /= 2;
    try_ladder(scene);
}

/// From long steps to short ones, until one keeps the error or is not worth its time. Whether one does.
bool Adviser::try_ladder(const Scene& from) {
    const double radius = smallest_radius(scene_);
    for (const double share : {1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01}) {
        Scene scene = stepped(from, course_, share * radius / speed_);
        const double step = rounded_down(scene.step.value_or(course_.stretch));
        scene.step = step;
        const double tolerance = std::clamp(kPartOfTolerance * options_.error, kLeastTolerance, 1e-3);
        scene.tolerance = rounded_down(tolerance * radius);
        const Trial* const trial = try_one(with_field(fmt::format("step {:.4g}", step), scene), scene);
        if (trial == nullptr || !trial->errors) return false;
        if (trial->keeps) return true;
    }
    return false;
}

const Trial* Adviser::try_one(const std::string& name, const Scene& scene) {
    if (!has_time()) return nullptr;
    options_.on_trial(name);
    const auto begin = std::chrono::steady_clock::now();
    const double limit =
        std::max(kTooSlow * best_time() * events_.front().seconds, kShareOfARun * options_.seconds);
    const auto goes_on = [&] { return seconds_since(begin) < limit && has_time(); };
    const Trace t = trace(scene, course_, {.threads = options_.threads, .goes_on = goes_on});
    Trial trial{name, scene, {}, {}, 0, false};
    if (t.is_whole) {
        judge(trial, t);
        time(trial);
    }
    advice_.trials.push_back(std::move(trial));
    return &advice_.trials.back();
}

double Adviser::best_time() const {
    double best = 1;
    for (const Trial& t : advice_.trials)
        if (t.keeps && t.time) best = std::min(best, t.time->median);
    return best;
}

// The scene's own event method unless another is faster by more than the clock's noise.
void Adviser::choose() {
    double best = HUGE_VAL;
    for (std::size_t k = 0; k < advice_.trials.size(); ++k) {
        const Trial& t = advice_.trials[k];
        if (!t.keeps || !t.time || t.time->median >= best) continue;
        advice_.choice = k;
        best = k == 0 ? kClearlyFaster : t.time->median;
    }
}

std::string Adviser::with_field(const std::string& name, const Scene& scene) const {
    if (scene.field_interval == scene_.field_interval) return name;
    return fmt::format("{}, field interval {:.4g}", name, scene.field_interval);
}

}  // namespace

Advice advise(const Scene& scene, const AdviceOptions& options) {
    return Adviser(scene, options).advise();
}

}  // namespace carom::trade
