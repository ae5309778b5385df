#include <carom/trade/matching.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

namespace carom::trade {
namespace {

/// The bodies, the smaller number first, and which of each one's collisions it is.
using Identity = std::array<std::uint32_t, 4>;

struct Known {
    double time = 0;
    bool is_reference = false;
    Identity identity{};
};

bool has_history(const std::vector<bool>& moves, std::uint32_t body) {
    return body < moves.size() && moves[body];
}

/// The first collisions of each ball, in the order of the list.
std::vector<Known> first_ones(const std::vector<Meeting>& list, bool is_reference,
                              const std::vector<bool>& moves, std::uint32_t first) {
    std::vector<std::uint32_t> counts(moves.size(), 0);
    const auto ordinal = [&](std::uint32_t body) { return has_history(moves, body) ? counts[body]++ : 0; };
    std::vector<Known> known;
    for (const Meeting& m : list) {
        const auto [a, b] = std::minmax(m.a, m.b);
        const std::uint32_t of_a = ordinal(a);
        const std::uint32_t of_b = ordinal(b);
        if (of_a < first && of_b < first) known.push_back({m.time, is_reference, {a, b, of_a, of_b}});
    }
    return known;
}

std::map<Identity, double> times_of(const std::vector<Known>& list) {
    std::map<Identity, double> times;
    for (const Known& k : list) times.emplace(k.identity, k.time);
    return times;
}

}  // namespace

Matching match(const std::vector<Meeting>& reference, const std::vector<Meeting>& other,
               const std::vector<bool>& moves, const MatchingRules& rules) {
    const std::vector<Known> ours = first_ones(reference, true, moves, rules.first);
    const std::vector<Known> others = first_ones(other, false, moves, rules.first);
    const std::map<Identity, double> times = times_of(ours);
    const std::map<Identity, double> times_of_other = times_of(others);
    std::vector<Known> all;  // of the same time, the reference's first
    std::ranges::merge(ours, others, std::back_inserter(all), {}, &Known::time, &Known::time);

    std::vector<bool> strays(moves.size(), false);
    Matching result;
    for (const Known& k : all) {
        if (k.time > rules.until) break;
        const std::uint32_t a = k.identity[0];
        const std::uint32_t b = k.identity[1];
        const auto strayed = [&](std::uint32_t body) { return has_history(moves, body) && strays[body]; };
        bool agrees = !strayed(a) && !strayed(b);
        if (agrees) {
            const auto& wanted = k.is_reference ? times_of_other : times;
            const auto found = wanted.find(k.identity);
            agrees = found != wanted.end() && std::abs(found->second - k.time) <= rules.window;
            if (k.is_reference) ++result.compared;
            if (!agrees) ++(k.is_reference ? result.missed : result.invented);
            if (!agrees && !result.first_fault) result.first_fault = k.time;
        }
        if (agrees) continue;
        for (const std::uint32_t body : {a, b})
            if (has_history(moves, body)) strays[body] = true;
    }
    return result;
}

}  // namespace carom::trade
