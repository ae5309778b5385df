// What a kind of query came to, and the line of a table that says so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace carom::accuracy {

struct Tally {
    std::string kind;
    std::int64_t queries = 0, hits = 0;
    /// Queries that the inputs' own rounding decides; and, of all, the wrong answers inside and outside.
    std::int64_t band = 0, missed_in_band = 0, invented_in_band = 0, missed = 0, invented = 0;
    /// Queries that went to the slow oracle: because the fast one left them open, and as a cross-check, with
    /// how often it did not confirm.
    std::int64_t open = 0, checked = 0, unconfirmed = 0;
    /// Errors of the times: in units of the condition, and relative in half ulps of 1 (1.1e-16).
    std::vector<float> in_units, relative;
};

/// The q-th quantile, 0 <= q <= 1; reorders `values`.
double quantile(std::vector<float>& values, double q);

std::string tally_header();
std::string tally_line(Tally& tally);
/// One line on how the oracles agreed over several kinds.
std::string oracle_line(const std::vector<Tally>& tallies);

/// 1234567 as 1,234,567; 0 as it is.
std::string grouped(std::int64_t n);
/// Two digits.
std::string brief(double x);

}  // namespace carom::accuracy
