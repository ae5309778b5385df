// The stretches of a trial, what is looked at after each, and the worlds that are compared.
#include "examine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <carom/parallel/world.hpp>

#include "draw.hpp"
#include "edits.hpp"
#include "leg.hpp"
#include "overlaps.hpp"
#include "replay.hpp"
#include "watched.hpp"

namespace carom::stress {
namespace {

// Of time, between stops. The first stop is the beginning, the last one the end.
constexpr std::size_t kStretches = 5;
constexpr std::uint64_t kMostCollisions = 100'000;

/// Something that does not hold.
struct Failure {
    std::string check;
    std::string detail;
};

struct EnoughCollisions {};

class Examination {
 public:
    explicit Examination(const Trial& trial) : trial_(trial), scene_(trial.scene), draw_(trial.seed) {
        double end = 0;
        for (std::size_t k = 1; k <= kStretches; ++k) stops_[k] = end += draw_.uniform(0.05, 1);
        for (double& stop : stops_) stop *= scene_.until / end;
        stops_.back() = scene_.until;
    }

    Verdict run();

 private:
    void run_plain(Verdict& verdict);
    void run_through(Watched& plain, Replay& replay, Verdict& verdict);
    void edit_plain(Watched& plain, std::size_t stop, Replay& replay);
    void take_snapshot(const Watched& plain, std::size_t stop, bool is_edited);
    void follow_reference();
    void run_other(const std::string& name, const WorldOptions& options, bool in_frames, bool resumes);
    void restore_and_repeat(Watched& plain, const Snapshot& snapshot);
    void repeat_edits(Watched& watched, std::size_t stop);
    /// Whether the edits of a stop from the snapshot on are still to come. Those that have been made may have
    /// events at once, which no stop before them has.
    [[nodiscard]] bool is_before_edits(std::size_t stop) const {
        return stop > snapshot_stop_ || !snapshot_is_edited_;
    }
    void check_state(Watched& watched);
    void expect_same(Watched& watched, std::size_t stop, bool is_edited);
    void advance(Watched& watched, double stop, bool in_frames);
    [[nodiscard]] WorldOptions drawn_options();

    /// What a world shows at a stop.
    struct Shown {
        std::uint64_t hash, events, sensings, balls, walls, steps, missed;
        double virial, energy;
    };
    /// What of it is another; empty where nothing is.
    [[nodiscard]] static std::string difference(const Shown& got, const Shown& expected);
    [[nodiscard]] static Shown shown(const Watched& watched);

    /// An edit of the plain run, and what became of it.
    struct Taken {
        Edits edits;
        std::string answer;
    };

    const Trial& trial_;
    const Scene& scene_;
    Draw draw_;
    std::array<double, kStretches + 1> stops_{};
    std::size_t reached_ = 0;                           ///< stops of the plain run
    std::vector<std::array<Shown, 2>> plain_;           ///< a stop, before and after its edits
    std::array<std::vector<Taken>, kStretches> edits_;  ///< a stop
    std::vector<Leg> legs_;
    bool has_field_ = false;  ///< whether attractors have pulled

    std::optional<Snapshot> snapshot_;
    Seen seen_at_snapshot_;
    std::size_t snapshot_stop_ = 0;
    bool snapshot_is_edited_ = false;  ///< whether it was taken after the stop's edits
};

Examination::Shown Examination::shown(const Watched& w) {
    const Counts counts = w.world().counts();
    return {w.world().state_hash(),
            w.seen().events.value,
            w.seen().sensings.value,
            counts.ball_collisions,
            counts.wall_collisions,
            counts.steps.value_or(0),
            counts.missed_collisions.value_or(0),
            w.world().virial(),
            w.world().energy()};
}

std::string Examination::difference(const Shown& got, const Shown& expected) {
    if (got.hash != expected.hash) return "state";
    if (got.balls != expected.balls) return "number of ball collisions";
    if (got.walls != expected.walls) return "number of wall collisions";
    if (got.events != expected.events) return "list of collisions";
    if (got.steps != expected.steps) return "number of steps";
    if (got.missed != expected.missed) return "number of missed collisions";
    if (got.virial != expected.virial) return "virial";
    return got.energy != expected.energy ? "energy" : "";
}

WorldOptions Examination::drawn_options() {
    WorldOptions options;
    options.threads = 1 + static_cast<int>(draw_.below(static_cast<std::size_t>(trial_.threads)));
    double diameter = 0;
    for (const Ball& b : scene_.balls)
        if (!b.is_static) diameter = std::max(diameter, 2 * b.radius);
    if (draw_.one_in(2)) options.cell_size = diameter * draw_.uniform(1.02, 4);
    options.domains = 1 + static_cast<int>(draw_.below(10));
    // With a thread for each domain their loops stay from window to window.
    if (draw_.one_in(3)) options.domains = options.threads = std::max(2, trial_.threads);
    options.halo = static_cast<int>(draw_.below(7));
    return options;
}

void Examination::check_state(Watched& w) {
    if (const std::vector<Violation> found = w.world().validate(); !found.empty())
        throw Failure{"validate", w.name() + ": " + found.front().what};
    // Each edit, and each renewal of the field, may start a ball anew.
    double events = double(trial_.edits.size());
    for (const std::uint32_t of_ball : w.seen().by_ball) events = std::max<double>(events, of_ball);
    if (has_field_) events += w.world().time() / scene_.field_interval;
    if (const std::string fault = find_misplaced(scene_now(scene_, w.world()), w.world(), events);
        !fault.empty())
        throw Failure{"overlap", w.name() + ": " + fault};
}

void Examination::take_snapshot(const Watched& plain, std::size_t stop, bool is_edited) {
    if (stop != snapshot_stop_ || is_edited != snapshot_is_edited_) return;
    snapshot_ = plain.world().snapshot();
    seen_at_snapshot_ = plain.seen();
}

/// The edits of this stop are drawn for the plain run's state; all other worlds get the same.
void Examination::edit_plain(Watched& plain, std::size_t stop, Replay& replay) {
    World& world = plain.world();
    std::optional<Scene> now;  // where it is edited
    for (const std::uint32_t number : trial_.edits) {
        if (stretch_of_edit(trial_.seed, number, kStretches) != stop) continue;
        const Edits edits = draw_edits(trial_.seed, number, scene_, world);
        const Edited edited = apply_edits(world, edits);
        edits_[stop].push_back({edits, edited.answer});
        if (!edited.fault.empty())
            throw Failure{"edits", fmt::format("edit {} at time {}: {}", number, world.time(), edited.fault)};
        if (edited.is_refused) continue;
        now = scene_now(scene_, world);
        replay.start_anew(*now, world);  // each edit may bring what lasts: a rest time
    }
    if (!now) return;
    has_field_ = has_field_ || !now->attractors.empty();
    legs_.push_back(leg_from(*now, world, true));
}

void Examination::repeat_edits(Watched& w, std::size_t stop) {
    if (stop >= edits_.size()) return;
    for (const Taken& taken : edits_[stop]) {
        const Edited edited = apply_edits(w.world(), taken.edits);
        if (!edited.fault.empty()) throw Failure{"edits", w.name() + ": " + edited.fault};
        if (edited.answer != taken.answer)
            throw Failure{"edits", fmt::format("{}: an edit at time {} comes to '{}', must come to '{}'",
                                               w.name(), stops_[stop], edited.answer, taken.answer)};
    }
}

void Examination::run_through(Watched& plain, Replay& replay, Verdict& verdict) {
    for (std::size_t k = 0; k <= kStretches; ++k) {
        plain.world().advance_to(stops_[k]);
        verdict.time = stops_[k];
        legs_.back().end = stops_[k];
        replay.compare(plain.world());
        if (!replay.fault().empty()) return;
        check_state(plain);
        const Shown before = shown(plain);
        take_snapshot(plain, k, false);
        if (k < kStretches) edit_plain(plain, k, replay);
        plain_.push_back({before, shown(plain)});
        take_snapshot(plain, k, true);
        ++reached_;
    }
}

/// The run that all others are compared with: one thread, one domain, each stretch at once.
void Examination::run_plain(Verdict& verdict) {
    Watched plain("plain", World(scene_, {.threads = 1, .domains = 1}));
    has_field_ = !scene_.attractors.empty();
    Replay replay(scene_, plain.world());
    legs_.push_back(leg_from(scene_, plain.world(), false));
    std::uint64_t count = 0;
    plain.listen([&](const Collision& c) {
        if (++count > kMostCollisions) throw EnoughCollisions{};
        legs_.back().take(c);
        replay.take(c, scene_.method == Method::kEmpirical ? *plain.world().counts().steps : 0);
    });
    snapshot_stop_ = draw_.below(kStretches + 1);
    snapshot_is_edited_ = draw_.one_in(2);
    try {
        run_through(plain, replay, verdict);
    } catch (const EnoughCollisions&) {
        verdict.is_cut = true;
    } catch (const std::runtime_error& error) {
        verdict.is_refused = true;
        verdict.detail = error.what();
    }
    verdict.collisions = count;
    if (!replay.fault().empty()) throw Failure{"physics", replay.fault()};
    if (reached_ > kStretches && snapshot_) restore_and_repeat(plain, *snapshot_);
}

void Examination::restore_and_repeat(Watched& plain, const Snapshot& snapshot) {
    plain.listen(nullptr);
    plain.world().restore(snapshot);
    plain.set_seen(seen_at_snapshot_);
    for (std::size_t k = snapshot_stop_; k < reached_; ++k) {
        if (is_before_edits(k)) {
            plain.world().advance_to(stops_[k]);
            repeat_edits(plain, k);
        }
        if (const std::string what = difference(shown(plain), plain_[k][1]); !what.empty())
            throw Failure{"restore", fmt::format("restored at time {}, another {} at time {}",
                                                 stops_[snapshot_stop_], what, stops_[k])};
    }
}

/// Event by event against the engine that looks at all pairs, from the start and after each edit.
void Examination::follow_reference() {
    if (reached_ == 0) return;
    for (const Leg& leg : legs_)
        if (const std::string difference = find_difference(leg); !difference.empty())
            throw Failure{"reference", difference};
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

void Examination::expect_same(Watched& w, std::size_t stop, bool is_edited) {
    if (const std::string what = difference(shown(w), plain_[stop][is_edited ? 1 : 0]); !what.empty())
        throw Failure{"same bits", fmt::format("{}: another {} at time {}{}", w.name(), what, stops_[stop],
                                               is_edited ? ", after its edits" : "")};
}

void Examination::run_other(const std::string& kind, const WorldOptions& options, bool in_frames,
                            bool resumes) {
    const std::string name = fmt::format("{} (threads {}, domains {}, halo {}, cell size {})", kind,
                                         options.threads, options.domains, options.halo, options.cell_size);
    std::optional<Watched> watched;
    if (resumes && snapshot_) {
        watched.emplace(name, World(scene_, options, *snapshot_));
        watched->set_seen(seen_at_snapshot_);
    } else {
        watched.emplace(name, World(scene_, options));
    }
    for (std::size_t k = resumes ? snapshot_stop_ : 0; k < reached_; ++k) {
        if (!resumes || is_before_edits(k)) {
            advance(*watched, stops_[k], in_frames);
            check_state(*watched);
            expect_same(*watched, k, false);
            repeat_edits(*watched, k);
        }
        expect_same(*watched, k, true);
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
