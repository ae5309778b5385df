#include "study_settings.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <carom/trade/errors.hpp>
#include <carom/trade/settings.hpp>

namespace carom::bench {
namespace {

constexpr double kUsualStep = 0.05;  // at which the other keys are varied

/// Collects settings; with `few` only those that a quick look needs.
class Settings {
 public:
    Settings(const StudyScene& s, bool few) : s_(s), few_(few) {}

    void add(const std::string& name, const Scene& scene, bool is_needed = false) {
        if (!few_ || is_needed) all_.push_back({name, scene});
    }

    /// A longer step than a stretch would be shortened to one: that is no setting of its own.
    [[nodiscard]] bool has_step(double share) const { return share * s_.unit <= s_.course.stretch; }

    [[nodiscard]] Scene stepped(double share) const {
        return trade::stepped(s_.scene, s_.course, share * s_.unit);
    }

    void add_precision() {
        Scene scene = s_.scene;
        scene.precision = Precision::kFloat;
        add("event, float", scene, true);
        scene = stepped(kUsualStep);
        scene.precision = Precision::kFloat;
        add(fmt::format("step {}, float", kUsualStep), scene);
    }

    void add_steps() {
        for (const double share : {1.0, 0.5, 0.2, 0.1, 0.05})
            if (has_step(share))
                add(fmt::format("step {}", share), stepped(share), share == 0.2 || share == 0.05);
        for (const double travel : {0.5, 0.2, 0.1}) {
            Scene scene = s_.scene;
            scene.method = Method::kEmpirical;
            scene.max_travel = travel;
            add(fmt::format("travel {}", travel), scene, travel == 0.2);
        }
    }

    /// Tolerances at one step, and steps with the finest of them, which hides no other error.
    void add_tolerances() {
        const double radius = trade::smallest_radius(s_.scene);
        const auto add_one = [&](double share, double tolerance, bool is_needed) {
            Scene scene = stepped(share);
            scene.tolerance = tolerance * radius;
            add(fmt::format("step {}, tol {:.0e}", share, tolerance), scene, is_needed);
        };
        add_one(kUsualStep, 1e-3, false);
        for (const double share : {0.5, 0.2, 0.1, 0.05, 0.02})
            if (has_step(share)) add_one(share, 1e-9, share == kUsualStep);
    }

    void add_field_intervals() {
        if (s_.scene.attractors.empty()) return;
        for (const double factor : {0.125, 0.25, 0.5, 2.0, 4.0}) {
            Scene scene = s_.scene;
            scene.field_interval *= factor;
            add(fmt::format("event, field x {}", factor), scene, factor == 0.25 || factor == 4);
        }
        for (const double factor : {0.125, 0.25, 0.5, 2.0}) {
            Scene scene = stepped(0.2);
            scene.field_interval *= factor;
            add(fmt::format("step 0.2, field x {}", factor), scene, factor == 0.25);
        }
    }

    void add_contact_times() {
        if (!s_.scene.contact_time) return;
        for (const double factor : {0.1, 10.0}) {
            Scene scene = s_.scene;
            scene.contact_time = *scene.contact_time * factor;
            add(fmt::format("event, contact time x {}", factor), scene);
        }
    }

    [[nodiscard]] const std::vector<Setting>& all() const { return all_; }

 private:
    const StudyScene& s_;
    bool few_;
    std::vector<Setting> all_;
};

}  // namespace

std::vector<Setting> settings_of(const StudyScene& s, bool few) {
    Settings settings(s, few);
    settings.add("event", s.scene, true);
    settings.add_precision();
    settings.add_steps();
    settings.add_tolerances();
    settings.add_field_intervals();
    settings.add_contact_times();
    std::vector<Setting> all = settings.all();
    all.push_back({"reference, moved 1e-12", trade::moved_a_little(s.reference), false});
    return all;
}

}  // namespace carom::bench
