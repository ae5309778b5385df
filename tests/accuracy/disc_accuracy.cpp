#include "accuracy/disc_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <carom/core/disc_time.hpp>

#include "accuracy/exact.hpp"

namespace carom::accuracy {
namespace {

/// From here on the slow oracle is asked again.
constexpr Wide kSuspicious = 4;

double found_time(const DiscQuery& q) {
    return q.straight() ? disc_time_of_impact<double>(q.r, q.v, q.s)
                        : disc_time_of_impact<double>(q.r, q.v, q.a, q.s);
}

/// The same source in 100 digits.
bool agrees_in_many_digits(const DiscQuery& q, const Truth& truth, Wide slack) {
    using test::Big;
    const Big t = disc_time_of_impact<Big>(test::big(q.r), test::big(q.v), test::big(q.a), Big(q.s));
    const bool hit = t < std::numeric_limits<Big>::infinity();
    if (hit != (truth.verdict == Verdict::kHit)) return false;
    return !hit || abs(t - Big(static_cast<Wide>(truth.time))) <=
                       Big(slack + 0x1p-62L * static_cast<Wide>(truth.time));
}

struct Comparison {
    bool missed = false, invented = false;
    Wide error = 0, units = 0;
};

Comparison compare(const DiscQuery& q, const Truth& truth, double found) {
    Comparison c;
    const bool hit = truth.verdict == Verdict::kHit;
    c.missed = hit && !(found < kNever);
    c.invented = !hit && found < kNever;
    if (!hit || c.missed) return c;
    c.error = static_cast<Wide>(magnitude(Quad(found) - truth.time));
    c.units = c.error > 0 ? c.error / condition(q, truth).time : 0;
    if (!(c.units <= kOtherRoot)) c.missed = true;
    return c;
}

void check(const DiscQuery& q, const Truth& truth, Tally& tally) {
    ++tally.checked;
    Wide slack = 0;
    if (truth.verdict == Verdict::kHit && truth.time != 0) slack = Wide(2e-4) * condition(q, truth).time;
    bool same = confirms(q, truth, slack);
    if (!same) {
        const Truth exact = exact_truth(q);
        same = exact.verdict == truth.verdict && magnitude(exact.time - truth.time) <= Quad(slack);
    }
    if (!same || !agrees_in_many_digits(q, truth, slack)) ++tally.unconfirmed;
}

}  // namespace

Tally measure(const DiscKind& kind, std::uint64_t seed, const Effort& effort) {
    Tally tally;
    tally.kind = kind.name;
    test::Random random(seed);
    for (std::int64_t i = 0; i < effort.queries; ++i) {
        const DiscQuery q = kind.make(random);
        const double found = found_time(q);
        Truth truth = quad_truth(q);
        const bool open = truth.verdict == Verdict::kUndecided;
        if (open) truth = exact_truth(q);
        Comparison c = compare(q, truth, found);
        if (!open && (c.missed || c.invented || c.units > kSuspicious)) {
            truth = exact_truth(q);
            c = compare(q, truth, found);
        }
        if (i % effort.check_every == 0) check(q, truth, tally);

        ++tally.queries;
        tally.hits += truth.verdict == Verdict::kHit ? 1 : 0;
        tally.open += open ? 1 : 0;
        const bool band = in_band(q, truth);
        tally.band += band ? 1 : 0;
        (band ? tally.missed_in_band : tally.missed) += c.missed ? 1 : 0;
        (band ? tally.invented_in_band : tally.invented) += c.invented ? 1 : 0;
        if (truth.verdict != Verdict::kHit || c.missed || band) continue;
        tally.in_units.push_back(static_cast<float>(c.units));
        if (truth.time != 0)
            tally.relative.push_back(static_cast<float>(c.error / static_cast<Wide>(truth.time) * 0x1p53L));
    }
    return tally;
}

Seam measure_seam(double low, double high, std::uint64_t seed, std::int64_t queries) {
    Seam seam{low, high};
    test::Random random(seed);
    for (std::int64_t i = 0; i < queries; ++i) {
        DiscQuery q = straight_query(random);
        const double straight = found_time(q);
        Truth without = quad_truth(q);
        q.a = random.direction(random.decades(low, high));
        const double curved = found_time(q);
        Truth with = quad_truth(q);
        if (with.verdict == Verdict::kUndecided) with = exact_truth(q);
        ++seam.queries;
        const bool hit = with.verdict == Verdict::kHit;
        seam.hits += hit ? 1 : 0;
        if ((curved < kNever) != hit && !in_band(q, with)) ++seam.verdicts_differ;
        if (!hit || !(curved < kNever)) continue;
        const Comparison c = compare(q, with, curved);
        seam.worst_in_units = std::max(seam.worst_in_units, static_cast<double>(c.units));
        if (!(straight < kNever) || without.verdict != Verdict::kHit) continue;
        const Quad jump = (Quad(curved) - Quad(straight)) - (with.time - without.time);
        seam.worst_seam = std::max(seam.worst_seam, static_cast<double>(magnitude(jump) / without.time));
    }
    return seam;
}

}  // namespace carom::accuracy
