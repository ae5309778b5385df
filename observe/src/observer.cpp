// Observer: the scalars of a sample, and who is handed the rest.
#include <carom/observe/observer.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "correlations.hpp"
#include "structure.hpp"

namespace carom {
namespace {

using observe::Correlations;
using observe::Profiles;
using observe::RadialDistribution;

std::vector<std::uint32_t> ids_of_moving(const std::vector<Ball>& balls) {
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < balls.size(); ++i)
        if (!balls[i].is_static) ids.push_back(static_cast<std::uint32_t>(i));
    return ids;
}

std::vector<std::uint32_t> spread_over(const std::vector<std::uint32_t>& ids, std::size_t most) {
    if (ids.size() <= most) return ids;
    std::vector<std::uint32_t> some(most);
    for (std::size_t k = 0; k < most; ++k) some[k] = ids[k * ids.size() / most];
    return some;
}

double mean_diameter_of(const std::vector<Ball>& balls, const std::vector<std::uint32_t>& ids) {
    double sum = 0;
    for (const std::uint32_t id : ids) sum += 2 * balls[id].radius;
    return ids.empty() ? 1 : sum / double(ids.size());
}

double area_of(const Box& box) {
    return (box.max.x() - box.min.x()) * (box.max.y() - box.min.y());
}

double cutoff_of(const ObserverOptions& options, const Domain& domain, std::size_t count) {
    if (options.neighbour_cutoff > 0) return options.neighbour_cutoff;
    const double spacing =
        std::sqrt(2 / std::sqrt(3.0) * area_of(domain.box) / double(std::max<std::size_t>(count, 1)));
    return (1 + std::sqrt(3.0)) / 2 * spacing;
}

}  // namespace

class Observer::State {
 public:
    State(const World& world, const ObserverOptions& wanted) : State(world, wanted, world.balls()) {}
    State(const World& world, const ObserverOptions& wanted, const std::vector<Ball>& balls)
        : options(wanted),
          domain(world.domain()),
          all(balls.size()),
          first_side(static_cast<std::uint32_t>(world.wall_count())),
          ids(ids_of_moving(balls)),
          mean_diameter(mean_diameter_of(balls, ids)),
          cutoff(cutoff_of(wanted, domain, ids.size())),
          radial(domain, wanted.reach * mean_diameter, wanted.bin * mean_diameter),
          profiles(domain, std::max<std::size_t>(wanted.profile_bins, 1)),
          correlations(spread_over(ids, wanted.tracked), wanted.lags) {
        for (const std::uint32_t id : ids) masses.push_back(balls[id].mass);
        const auto is_walled = [](Boundary b) { return b == Boundary::kWall; };
        drifts = ids.size() == balls.size() && world.wall_count() == 0 &&
                 std::ranges::none_of(domain.boundary, is_walled);
    }

    void energies(const PlaneVectors& velocities, Sample& s) {
        Vec2 momentum = Vec2::Zero();
        double mass = 0;
        double twice = 0;
        double speeds = 0;
        for (std::size_t k = 0; k < ids.size(); ++k) {
            const Vec2& v = velocities[ids[k]];
            const double squared = length_squared(v);
            momentum += masses[k] * v;
            mass += masses[k];
            twice += masses[k] * squared;
            speeds += std::sqrt(squared);
        }
        s.kinetic_energy = twice / 2;
        const double drift = drifts && mass > 0 ? length_squared(momentum) / mass : 0;
        const double free = 2 * (double(ids.size()) - (drifts ? 1 : 0));
        if (free > 0) s.temperature = (twice - drift) / free;
        mean_speed = ids.empty() ? 0 : speeds / double(ids.size());
    }

    void rates(const World& world, Sample& s) {
        const Counts counts = world.counts();
        const double virial = world.virial();
        const double elapsed = s.time - last_time;
        if (has_sampled) {
            const double hits = double(counts.ball_collisions - last_counts.ball_collisions);
            s.ball_collision_rate = hits / elapsed;
            s.wall_collision_rate = double(counts.wall_collisions - last_counts.wall_collisions) / elapsed;
            // Each collision is one of two balls'.
            if (hits > 0) s.mean_free_path = mean_speed * double(ids.size()) * elapsed / (2 * hits);
            const bool is_periodic =
                domain.boundary[0] == Boundary::kPeriodic && domain.boundary[1] == Boundary::kPeriodic;
            if (is_periodic && s.temperature)
                s.pressure = (double(ids.size()) * *s.temperature + (virial - last_virial) / (2 * elapsed)) /
                             area_of(domain.box);
            if (options.records_collisions) wall_pressures(elapsed, s);
        }
        impulses.fill(0);
        last_counts = counts;
        last_virial = virial;
        last_time = s.time;
        has_sampled = true;
    }

    void wall_pressures(double elapsed, Sample& s) const {
        const Vec2 sides = domain.box.max - domain.box.min;
        for (std::size_t side = 0; side < 4; ++side)
            if (domain.boundary[side / 2] == Boundary::kWall)
                s.wall_pressure[side] = impulses[side] / (elapsed * (side < 2 ? sides.y() : sides.x()));
    }

    void displacement(const PlaneVectors& unwrapped, Sample& s) {
        if (origin.empty())
            for (const std::uint32_t id : ids) origin.push_back(unwrapped[id]);
        double sum = 0;
        for (std::size_t k = 0; k < ids.size(); ++k)
            sum += length_squared<double>(unwrapped[ids[k]] - origin[k]);
        s.mean_square_displacement = ids.empty() ? 0 : sum / double(ids.size());
    }

    Sample sample(const World& world) {
        if (world.ball_count() != all)
            throw std::invalid_argument("an observer needs the balls that it began with");
        if (has_sampled && !(world.time() > last_time))
            throw std::invalid_argument("an observer needs a later time than that of the sample before");
        Sample s;
        s.time = world.time();
        const PlaneVectors velocities = world.velocities();
        const PlaneVectors unwrapped = world.unwrapped_positions();
        energies(velocities, s);
        rates(world, s);
        displacement(unwrapped, s);
        std::vector<Vec2> points;
        points.reserve(ids.size());
        const PlaneVectors positions = world.positions();
        for (const std::uint32_t id : ids) points.push_back(positions[id]);
        if (options.hexatic && !points.empty())
            std::tie(s.hexatic_global, s.hexatic_local) = observe::hexatic_order(points, domain, cutoff);
        if (options.structure && s.time >= options.average_from) {
            radial.add(points);
            profiles.add(points);
            correlations.add(s.time, unwrapped, velocities);
            if (averaged++ == 0) first_averaged = s.time;
        }
        return s;
    }

    [[nodiscard]] Structure structure() const {
        Structure s;
        s.samples = averaged;
        s.first_time = first_averaged;
        s.last_time = averaged > 0 ? last_time : 0;
        s.mean_diameter = mean_diameter;
        s.radial_distribution = radial.curve();
        s.density_x = profiles.curve(0);
        s.density_y = profiles.curve(1);
        correlations.give(s.mean_square_displacement, s.velocity_autocorrelation);
        return s;
    }

    /// The words that save() gives; the first number changes when their meaning does.
    template <class Words>
    void visit(Words& words) {
        words.same(std::uint64_t{1});
        words.same(options.records_collisions);
        words.same(options.average_from);
        words.same(options.reach);
        words.same(options.bin);
        words.same(std::uint64_t{options.profile_bins});
        words.same(std::uint64_t{options.lags});
        words.same(std::uint64_t{options.tracked});
        words.same(options.neighbour_cutoff);
        words.same(options.hexatic);
        words.same(options.structure);
        words.same(std::uint64_t{all});
        words.same(std::uint64_t{ids.size()});
        words(impulses, has_sampled, last_time, last_virial, last_counts.ball_collisions,
              last_counts.wall_collisions, averaged, first_averaged);
        if (has_sampled) {
            origin.resize(ids.size());
            words(origin);
        }
        radial.visit(words);
        profiles.visit(words);
    }

    ObserverOptions options;
    Domain domain;
    std::size_t all;           // balls, static ones too
    std::uint32_t first_side;  // as a wall's index
    std::vector<std::uint32_t> ids;
    std::vector<double> masses;
    double mean_diameter;
    double cutoff;
    bool drifts = false;  // whether the centre of mass moves freely
    RadialDistribution radial;
    Profiles profiles;
    Correlations correlations;
    std::array<double, 4> impulses{};  // on the sides, since the last sample
    bool has_sampled = false;
    double last_time = 0;
    double last_virial = 0;
    Counts last_counts;
    double mean_speed = 0;
    std::vector<Vec2> origin;
    std::uint64_t averaged = 0;
    double first_averaged = 0;
};

Observer::Observer(const World& world, const ObserverOptions& options)
    : state_(std::make_unique<State>(world, options)) {}
Observer::~Observer() = default;
Observer::Observer(Observer&&) noexcept = default;
Observer& Observer::operator=(Observer&&) noexcept = default;

void Observer::record(const Collision& collision) {
    if (collision.kind != CollisionKind::kWall || collision.j < state_->first_side) return;
    state_->impulses[collision.j - state_->first_side] += collision.impulse;
}

Sample Observer::sample(const World& world) {
    return state_->sample(world);
}

Structure Observer::structure() const {
    return state_->structure();
}

std::vector<std::uint64_t> Observer::save() const {
    std::vector<std::uint64_t> words;
    observe::WordSink sink(words);
    state_->visit(sink);
    state_->correlations.save(sink);
    return words;
}

void Observer::restore(std::span<const std::uint64_t> words) {
    observe::WordSource source(words);
    state_->visit(source);
    state_->correlations.restore(source);
    source.require_end();
}

}  // namespace carom
