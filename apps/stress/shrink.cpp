#include "shrink.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace carom::stress {
namespace {

class Shrinker {
 public:
    Shrinker(Trial& trial, Verdict& verdict, const std::function<bool()>& may_go_on)
        : trial_(trial), verdict_(verdict), may_go_on_(may_go_on) {}

    void run() {
        do {
            changed_ = false;
            remove_parts([](Trial& t) -> auto& { return t.edits; });
            end_earlier();
            remove_parts([](Trial& t) -> auto& { return t.scene.balls; });
            remove_parts([](Trial& t) -> auto& { return t.scene.walls; });
            remove_parts([](Trial& t) -> auto& { return t.scene.attractors; });
            remove_parts([](Trial& t) -> auto& { return t.scene.sensors; });
            forget_features();
            simplify_balls();
        } while (changed_ && may_go_on_());
    }

 private:
    /// Keeps the change where the scene still fails.
    bool try_change(const std::function<void(Scene&)>& change) {
        return try_trial([&change](Trial& t) { change(t.scene); });
    }
    bool try_trial(const std::function<void(Trial&)>& change) {
        if (!may_go_on_()) return false;
        Trial smaller = trial_;
        change(smaller);
        const Verdict verdict = examine(smaller);
        if (verdict.check != verdict_.check) return false;
        trial_ = std::move(smaller);
        verdict_ = verdict;
        changed_ = true;
        return true;
    }

    void end_earlier() {
        if (verdict_.time > 0 && verdict_.time < trial_.scene.until)
            try_change([this](Scene& s) { s.until = verdict_.time; });
        for (const double factor : {0.1, 0.5, 0.9})
            while (try_change([factor](Scene& s) { s.until *= factor; })) {
            }
    }

    /// Halves, quarters and so on of a list, as long as taking one out leaves the failure (delta debugging,
    /// Zeller and Hildebrandt 2002).
    template <class ListOf>
    void remove_parts(ListOf list) {
        for (std::size_t piece = list(trial_).size(); piece > 0; piece /= 2) {
            for (std::size_t first = 0; first < list(trial_).size();) {
                const bool removed = try_trial([&](Trial& t) {
                    auto& parts = list(t);
                    const auto from = parts.begin() + static_cast<std::ptrdiff_t>(first);
                    parts.erase(from,
                                from + static_cast<std::ptrdiff_t>(std::min(piece, parts.size() - first)));
                });
                if (!removed) first += piece;
                if (!may_go_on_()) return;
            }
        }
    }

    void forget_features() {
        const Scene plain;
        const auto reset = [&](auto Scene::* field) {
            if (trial_.scene.*field != plain.*field) try_change([&](Scene& s) { s.*field = plain.*field; });
        };
        reset(&Scene::gravity);
        reset(&Scene::restitution_rule);
        reset(&Scene::contact_time);
        reset(&Scene::speed_factor);
        reset(&Scene::precision);
        reset(&Scene::method);
        reset(&Scene::step);
        reset(&Scene::max_travel);
        reset(&Scene::tolerance);
        reset(&Scene::allows_overlap);
        reset(&Scene::field_interval);
        if (!trial_.scene.domain) return;
        if (try_change([](Scene& s) { s.domain.reset(); })) return;
        if (trial_.scene.domain->restitution != 1) try_change([](Scene& s) { s.domain->restitution = 1; });
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (trial_.scene.domain->boundary[axis] != Boundary::kOpen)
                try_change([axis](Scene& s) { s.domain->boundary[axis] = Boundary::kOpen; });
    }

    void simplify_balls() {
        const Ball plain;
        const auto reset = [&](auto Ball::* field) {
            const auto is_plain = [&](const Ball& b) { return b.*field == plain.*field; };
            if (std::ranges::all_of(trial_.scene.balls, is_plain)) return;
            if (try_change([&](Scene& s) {
                    for (Ball& b : s.balls) b.*field = plain.*field;
                }))
                return;
            if (trial_.scene.balls.size() > kFewBalls) return;
            for (std::size_t i = 0; i < trial_.scene.balls.size(); ++i)
                if (!is_plain(trial_.scene.balls[i]))
                    try_change([&](Scene& s) { s.balls[i].*field = plain.*field; });
        };
        reset(&Ball::acceleration);
        reset(&Ball::restitution);
        reset(&Ball::mass);
        reset(&Ball::is_static);
        reset(&Ball::velocity);
        reset(&Ball::filter);
    }

    static constexpr std::size_t kFewBalls = 20;

    Trial& trial_;
    Verdict& verdict_;
    const std::function<bool()>& may_go_on_;
    bool changed_ = false;
};

}  // namespace

Trial shrink(Trial trial, Verdict& verdict, const std::function<bool()>& may_go_on) {
    Shrinker(trial, verdict, may_go_on).run();
    return trial;
}

}  // namespace carom::stress
