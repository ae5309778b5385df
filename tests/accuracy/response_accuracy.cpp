#include "accuracy/response_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/across.hpp"
#include "accuracy/quad.hpp"
#include "accuracy/tally.hpp"

namespace carom::accuracy {
namespace {

using test::Random;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

ResponseQuery any_pair(Random& random, double mass_decades, double e) {
    ResponseQuery q{random.vector(1),
                    random.vector(1),
                    random.direction(random.decades(-3, 3)),
                    random.decades(-mass_decades, mass_decades),
                    random.decades(-mass_decades, mass_decades),
                    e};
    if (dot<double>(q.offset, Vec2(q.va - q.vb)) > 0) q.offset = -q.offset;
    return q;
}

/// One restitution from two by the rule.
auto by_rule(RestitutionRule rule) {
    return [rule](Random& random) {
        const double e_a = random.uniform(0, 1);
        return any_pair(random, 2, pair_restitution<double>(rule, e_a, random.uniform(0, 1)));
    };
}

/// Approach at `slow` of the speed past each other.
ResponseQuery grazing(Random& random) {
    ResponseQuery q = any_pair(random, 3, 1);
    const Vec2 n = q.offset.normalized();
    q.vb = q.va + n * random.decades(-15, -1) + across(n) * random.uniform(-1, 1);
    if (dot<double>(q.offset, Vec2(q.va - q.vb)) > 0) q.offset = -q.offset;
    return q;
}

ResponseQuery head_on(Random& random) {
    ResponseQuery q = any_pair(random, 3, 1);
    const Vec2 n = q.offset.normalized();
    q.va = -n * random.decades(-3, 3);
    q.vb = n * random.decades(-3, 3);
    return q;
}

/// Fast together: what they do to each other is small beside it.
ResponseQuery drifting(Random& random) {
    ResponseQuery q = any_pair(random, 2, 1);
    const Vec2 drift = random.direction(random.decades(0, 8));
    q.va += drift;
    q.vb += drift;
    if (dot<double>(q.offset, Vec2(q.va - q.vb)) > 0) q.offset = -q.offset;
    return q;
}

struct QuadPair {
    Quad x, y;
};

QuadPair difference(const Vec2& a, const Vec2& b) {
    return {Quad(a.x()) - Quad(b.x()), Quad(a.y()) - Quad(b.y())};
}

Quad along(const QuadPair& a, const QuadPair& b) {
    return a.x * b.x + a.y * b.y;
}

Quad energy(double mass, const Vec2& v) {
    return Quad(mass) * (Quad(v.x()) * Quad(v.x()) + Quad(v.y()) * Quad(v.y()));
}

float ulps(Quad error, Quad of) {
    return of == 0 ? 0 : static_cast<float>(magnitude(error) / of / Quad(kEpsilon));
}

/// Change of the total momentum of one component over what rounding must do to it: each velocity is stored to
/// half an ulp, and so is the quotient of impulse and mass.
Wide momentum_units(const ResponseQuery& q, double a_0, double a_1, double b_0, double b_1) {
    const Quad given_a = Quad(q.mass_a) * (Quad(a_1) - Quad(a_0));
    const Quad given_b = Quad(q.mass_b) * (Quad(b_1) - Quad(b_0));
    const Quad impulse = std::max(magnitude(given_a), magnitude(given_b));
    const Wide unit = static_cast<Wide>(impulse) * 0x1p-52L + Wide(q.mass_a) * half_ulp(a_1) +
                      Wide(q.mass_b) * half_ulp(b_1);
    return unit > 0 ? static_cast<Wide>(magnitude(given_a + given_b)) / unit : 0;
}

void compare(const ResponseQuery& q, ResponseTally& tally) {
    const auto after = collide<double>(q.va, q.vb, q.offset, q.mass_a, q.mass_b, q.e);
    tally.approaching += dot<double>(q.offset, Vec2(after.a - after.b)) < 0 ? 1 : 0;
    tally.momentum.push_back(
        static_cast<float>(std::max(momentum_units(q, q.va.x(), after.a.x(), q.vb.x(), after.b.x()),
                                    momentum_units(q, q.va.y(), after.a.y(), q.vb.y(), after.b.y()))));

    const QuadPair line{q.offset.x(), q.offset.y()};
    const Quad length_squared = along(line, line);
    const Quad approach = along(line, difference(q.va, q.vb));
    const Quad separation = along(line, difference(after.a, after.b));
    const Quad before = energy(q.mass_a, q.va) + energy(q.mass_b, q.vb);
    const Quad reduced = Quad(q.mass_a) * Quad(q.mass_b) / (Quad(q.mass_a) + Quad(q.mass_b));
    const Quad loss = (1 - Quad(q.e) * Quad(q.e)) * reduced * approach * approach / length_squared;
    tally.energy.push_back(
        ulps(energy(q.mass_a, after.a) + energy(q.mass_b, after.b) + loss - before, before));

    const Quad speed = std::max({q.va.norm(), q.vb.norm(), after.a.norm(), after.b.norm()});
    const Quad scale = square_root(length_squared) * speed;
    tally.separation.push_back(ulps(separation + Quad(q.e) * approach, scale));
    const QuadPair side{-line.y, line.x};
    const Quad turned =
        magnitude(along(side, difference(after.a, q.va))) + magnitude(along(side, difference(after.b, q.vb)));
    tally.tangent.push_back(ulps(turned, scale));
}

}  // namespace

std::vector<ResponseKind> response_kinds() {
    const auto of_masses = [](double decades, double e) {
        return [=](Random& random) { return any_pair(random, decades, e); };
    };
    return {{"elastic, masses 0.1 to 10", of_masses(1, 1)},
            {"elastic, mass ratios to 1e15", of_masses(7.5, 1)},
            {"elastic, head-on, speeds 1e-3 to 1e3", head_on},
            {"elastic, grazing, approach 1e-15 to 0.1", grazing},
            {"elastic, moving together at 1 to 1e8", drifting},
            {"restitution 0", of_masses(2, 0)},
            {"restitution 0, mass ratios to 1e15", of_masses(7.5, 0)},
            {"restitution 0 to 1, rule min", by_rule(RestitutionRule::kMin)},
            {"rule max", by_rule(RestitutionRule::kMax)},
            {"rule product", by_rule(RestitutionRule::kProduct)},
            {"rule mean", by_rule(RestitutionRule::kMean)},
            {"rule geometric", by_rule(RestitutionRule::kGeometric)}};
}

ResponseTally measure(const ResponseKind& kind, std::uint64_t seed, std::int64_t queries) {
    ResponseTally tally;
    tally.kind = kind.name;
    tally.queries = queries;
    Random random(seed);
    for (std::int64_t i = 0; i < queries; ++i) compare(kind.make(random), tally);
    return tally;
}

ResponseTally measure_bounce(const std::string& name, double e_least, std::uint64_t seed,
                             std::int64_t queries) {
    ResponseTally tally;
    tally.kind = name;
    tally.queries = queries;
    Random random(seed);
    for (std::int64_t i = 0; i < queries; ++i) {
        const Vec2 normal = random.direction(random.decades(-3, 3));
        const Vec2 v = across(normal.normalized()) * random.uniform(-1, 1) -
                       normal.normalized() * random.decades(-15, 0);
        const double e = random.uniform(e_least, 1);
        const Vec2 after = bounce<double>(v, normal, e);
        tally.approaching += dot<double>(normal, after) < 0 ? 1 : 0;
        const QuadPair line{normal.x(), normal.y()};
        const QuadPair side{-line.y, line.x};
        const Quad length_squared = along(line, line);
        const Quad approach = along(line, {v.x(), v.y()});
        const Quad loss = (1 - Quad(e) * Quad(e)) * approach * approach / length_squared;
        tally.energy.push_back(ulps(energy(1, after) + loss - energy(1, v), energy(1, v)));
        const Quad scale = square_root(length_squared) * Quad(v.norm());
        tally.separation.push_back(ulps(along(line, {after.x(), after.y()}) + Quad(e) * approach, scale));
        tally.tangent.push_back(ulps(along(side, difference(after, v)), scale));
    }
    return tally;
}

std::string response_header() {
    return "| kind | collisions | momentum in units, median | worst | energy in ulps, median | worst "
           "| separation in ulps, worst | tangents in ulps, worst | left approaching |\n"
           "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
}

std::string response_line(ResponseTally& t) {
    const auto momentum = [&](double q) { return t.momentum.empty() ? "" : brief(quantile(t.momentum, q)); };
    return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", t.kind, grouped(t.queries),
                       momentum(0.5), momentum(1), brief(quantile(t.energy, 0.5)),
                       brief(quantile(t.energy, 1)), brief(quantile(t.separation, 1)),
                       brief(quantile(t.tangent, 1)), t.approaching);
}

std::vector<double> energy_changes(int discs, const std::vector<std::int64_t>& counts, std::uint64_t seed) {
    Random random(seed);
    std::vector<Vec2> velocities;
    for (int i = 0; i < discs; ++i) velocities.push_back(random.vector(1));
    const double radius_sum = random.uniform(0.7, 1.3);
    const auto total = [&] {
        Quad sum = 0;
        for (const Vec2& v : velocities) sum += energy(1, v);
        return sum;
    };
    const Quad first = total();
    std::vector<double> changes;
    std::int64_t done = 0;
    for (const std::int64_t count : counts) {
        for (; done < count; ++done) {
            const auto i = static_cast<std::size_t>(random.uniform(0, discs));
            auto j = static_cast<std::size_t>(random.uniform(0, discs - 1));
            if (j >= i) ++j;
            Vec2 offset = random.direction(radius_sum);
            if (dot<double>(offset, Vec2(velocities[i] - velocities[j])) > 0) offset = -offset;
            const auto after = collide<double>(velocities[i], velocities[j], offset, 1.0, 1.0, 1.0);
            velocities[i] = after.a;
            velocities[j] = after.b;
        }
        changes.push_back(static_cast<double>((total() - first) / first));
    }
    return changes;
}

// A pair has 2/n of the energy; in a gas of many discs the square of its energy is 3/2 of the mean's square.
double random_walk(int discs, std::int64_t collisions) {
    const double share = discs > 2 ? std::sqrt(1.5) * 2 / discs : 1;
    return share * std::sqrt(12.0 * static_cast<double>(collisions)) * kEpsilon / std::sqrt(12.0);
}

}  // namespace carom::accuracy
