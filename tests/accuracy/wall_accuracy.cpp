#include "accuracy/wall_accuracy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "accuracy/across.hpp"
#include "core/many_digits.hpp"

namespace carom::accuracy {
namespace {

using test::Random;

WallQuery any_wall(Random& random, double pull_low, double pull_high) {
    const Vec2 p = random.vector(4);
    const Vec2 a = pull_high > -100 ? random.direction(random.decades(pull_low, pull_high)) : Vec2(0, 0);
    return {{p, random.vector(1) - p / 4, a}, random.uniform(0.01, 1), random.vector(2), random.vector(2)};
}

WallQuery along_axis(Random& random) {
    WallQuery q = any_wall(random, -2, 0.5);
    if (random.sign() > 0)
        q.to.x() = q.from.x();
    else
        q.to.y() = q.from.y();
    return q;
}

/// Past an end, or the face, at a distance of a radius and a little.
WallQuery graze_of_wall(Random& random, bool accelerated) {
    const Vec2 from = random.vector(2);
    const Vec2 to = from + random.direction(random.uniform(0.5, 4));
    const Vec2 along = (to - from).normalized();
    const double turn = random.uniform(-1.5, 1.5);
    const Vec2 n = -along * std::cos(turn) + across(along) * std::sin(turn);
    const Vec2 x = from + n * (0.5 * (1 + random.sign() * random.decades(-15, -1)));
    const Vec2 w = across(n) * (random.sign() * random.uniform(0.1, 2));
    const Vec2 a = accelerated ? random.vector(1) : Vec2(0, 0);
    const double t = random.uniform(0.1, 3);
    return {{x - w * t + a * (t * t / 2), w - a * t, a}, 0.5, from, to};
}

/// Straight at an end, from any side.
WallQuery at_end(Random& random) {
    WallQuery q = any_wall(random, -3, 0);
    const double t = random.uniform(0.5, 5);
    const Vec2 a = q.centre.acceleration;
    const Vec2 x = q.from + random.direction(q.radius * random.uniform(0, 1));
    q.centre.velocity = (x - q.centre.position) / t - a * (t / 2);
    return q;
}

/// Thrown up from beside the face, to come back to it or to an end.
WallQuery thrown_up(Random& random) {
    WallQuery q = any_wall(random, -1, 1);
    const Vec2 up = across((q.to - q.from).normalized()) * random.sign();
    q.centre.position =
        q.from + (q.to - q.from) * random.uniform(-0.5, 1.5) + up * q.radius * (1 + random.decades(-12, 0));
    q.centre.velocity = up * random.decades(-3, 1) + random.vector(1);
    q.centre.acceleration = up * -random.decades(-1, 1);
    return q;
}

WallQuery long_wall(Random& random) {
    const double length = random.decades(1, 6);
    WallQuery q = any_wall(random, -3, 0);
    q.from = random.vector(length);
    q.to = random.vector(length);
    const Vec2 foot = q.from + (q.to - q.from) * random.uniform(0, 1);
    const Vec2 up = across((q.to - q.from).normalized()) * random.sign();
    q.centre.position = foot + up * random.uniform(1.1, 10);
    q.centre.velocity = random.vector(1) - up * random.uniform(0, 2);
    return q;
}

WallQuery wall_of_any_unit(Random& random) {
    const double length = random.decades(-15, 15);
    const double time = random.decades(-12, 12);
    WallQuery q = any_wall(random, -2, 0.5);
    q.centre.position *= length;
    q.centre.velocity *= length / time;
    q.centre.acceleration *= length / time / time;
    return {q.centre, q.radius * length, q.from * length, q.to * length};
}

double largest(std::initializer_list<Vec2> vectors) {
    double most = 0;
    for (const Vec2& v : vectors) most = std::max({most, std::abs(v.x()), std::abs(v.y())});
    return most;
}

struct Contact {
    Wide gap_change;  ///< of the distance, by half an ulp in every input, against us
    Wide rate;        ///< of approach
};

/// Half an ulp of the largest coordinate for every coordinate: the face's direction is made of differences.
Contact contact_at(const WallQuery& q, Quad time) {
    const Motion<double>& m = q.centre;
    const auto t = static_cast<double>(time);
    const Vec2 place = position_at<double>(m, t);
    const Vec2 along = q.to - q.from;
    const double foot = dot<double>(along, Vec2(place - q.from)) / dot<double>(along, along);
    const Vec2 nearest = q.from + along * std::clamp(foot, 0.0, 1.0);
    const Vec2 n = (place - nearest).normalized();
    const double place_change = 2 * half_ulp(largest({m.position, q.from, q.to}));
    const double moved = t * (half_ulp(largest({m.velocity})) + t / 2 * half_ulp(largest({m.acceleration})));
    return {(std::abs(n.x()) + std::abs(n.y())) * (place_change + moved) + half_ulp(q.radius),
            std::abs(dot<double>(n, velocity_at<double>(m, t)))};
}

bool starts_outside(const WallQuery& q) {
    const Vec2 along = q.to - q.from;
    const double foot = dot<double>(along, Vec2(q.centre.position - q.from)) / dot<double>(along, along);
    const Vec2 nearest = q.from + along * std::clamp(foot, 0.0, 1.0);
    const double slack = 8 * half_ulp(largest({q.centre.position, q.from, q.to, Vec2(q.radius, 0)}));
    return (q.centre.position - nearest).norm() > q.radius + slack;
}

/// Whether half an ulp of everything decides on the hit at `time`: one that is there is not with the radius
/// so much smaller, or one that is not is with the radius so much larger. With -g t + k t^2 / 2 the gap from
/// the hit on, it falls below -c, where it ever does, within 2 c / g; a later hit is another one.
bool in_band(const WallQuery& q, const Contact& contact, Quad time, bool is_there) {
    // With k at most 2 |v|^2 / r + |a| until then, doubled for what v changes: deep enough to spare the
    // oracle.
    const Vec2 v = velocity_at<double>(q.centre, static_cast<double>(time));
    const double curve = 2 * (2 * v.squaredNorm() / q.radius + q.centre.acceleration.norm());
    if (is_there && contact.rate * contact.rate > 64 * curve * contact.gap_change) return false;
    const Quad change = contact.gap_change;
    const Quad slack = 3 * contact.gap_change / contact.rate;
    const WallTruth other = wall_truth(q, is_there ? -change : change);
    if (other.verdict == Verdict::kUndecided) return true;
    const bool hits_there = other.verdict == Verdict::kHit && other.time <= time + slack;
    return hits_there != is_there;
}

bool agrees_in_many_digits(const WallQuery& q, const WallTruth& truth, Wide slack) {
    using test::Big;
    const Motion<Big> m{test::big(q.centre.position), test::big(q.centre.velocity),
                        test::big(q.centre.acceleration)};
    const WallHit<Big> hit = wall_time_of_impact<Big>(m, Big(q.radius), test::big(q.from), test::big(q.to));
    if ((hit.time < std::numeric_limits<Big>::infinity()) != (truth.verdict == Verdict::kHit)) return false;
    return truth.verdict != Verdict::kHit || abs(hit.time - Big(static_cast<Wide>(truth.time))) <= Big(slack);
}

}  // namespace

std::vector<WallKind> wall_kinds() {
    const auto any = [](double low, double high) {
        return [=](Random& random) { return any_wall(random, low, high); };
    };
    return {{"any slant, straight", any(-200, -200)},
            {"any slant, accelerated", any(-2, 0.5)},
            {"acceleration 1e-30 to 1e3", any(-30, 3)},
            {"along an axis", along_axis},
            {"at an end", at_end},
            {"graze of an end, straight", [](Random& random) { return graze_of_wall(random, false); }},
            {"graze of an end, accelerated", [](Random& random) { return graze_of_wall(random, true); }},
            {"thrown up, gap from 1e-12", thrown_up},
            {"walls 10 to 1e6 long", long_wall},
            {"lengths 1e-15 to 1e15", wall_of_any_unit}};
}

Tally measure(const WallKind& kind, std::uint64_t seed, const Effort& effort) {
    Tally tally;
    tally.kind = kind.name;
    Random random(seed);
    while (tally.queries < effort.queries) {
        const WallQuery q = kind.make(random);
        if (!starts_outside(q)) continue;
        const double found = wall_time_of_impact<double>(q.centre, q.radius, q.from, q.to).time;
        const WallTruth truth = wall_truth(q, 0);
        ++tally.queries;
        if (truth.verdict == Verdict::kUndecided) {
            ++tally.open;
            continue;
        }
        const bool hit = truth.verdict == Verdict::kHit;
        tally.hits += hit ? 1 : 0;
        if (!hit && !(found < kNever)) continue;
        Quad time = hit ? truth.time : Quad(found);
        Contact contact = contact_at(q, time);
        const Wide unit = contact.gap_change / contact.rate + half_ulp(static_cast<double>(time));
        const Wide error = hit && found < kNever ? static_cast<Wide>(magnitude(Quad(found) - time)) : Wide(0);
        const bool is_right = hit && found < kNever && error <= kOtherRoot * unit;
        // Of two times that have nothing to do with each other the earlier one is to be explained.
        const bool invented = !is_right && (!hit || Quad(found) < time);
        if (invented && hit) contact = contact_at(q, time = found);
        const bool band = in_band(q, contact, time, !invented);
        tally.band += band ? 1 : 0;
        (band ? tally.missed_in_band : tally.missed) += !is_right && !invented ? 1 : 0;
        (band ? tally.invented_in_band : tally.invented) += invented ? 1 : 0;
        if (!is_right || band) continue;
        if (tally.queries % effort.check_every == 0) {
            ++tally.checked;
            const Wide slack = Wide(1e-3) * unit + 0x1p-62L * static_cast<Wide>(time);
            tally.unconfirmed += agrees_in_many_digits(q, truth, slack) ? 0 : 1;
        }
        tally.in_units.push_back(static_cast<float>(error / unit));
        tally.relative.push_back(static_cast<float>(error / static_cast<Wide>(time) * 0x1p53L));
    }
    return tally;
}

}  // namespace carom::accuracy
