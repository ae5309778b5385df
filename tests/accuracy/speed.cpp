#include "accuracy/speed.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <functional>

#include <unsupported/Eigen/Polynomials>

#include <carom/core/disc_time.hpp>

#include "accuracy/disc_kinds.hpp"

namespace carom::accuracy {
namespace {

constexpr std::size_t kQueries = 16384;  // too many for a branch predictor to learn
constexpr int kRounds = 15;

double carom_time(const DiscQuery& q) {
    return disc_time_of_impact<double>(q.r, q.v, q.a, q.s);
}

/// The first real root t >= 0 at which the gap falls, from the eigenvalues of the companion matrix.
double eigen_time(const DiscQuery& q) {
    Eigen::Matrix<double, 5, 1> c;
    c << dot<double>(q.r, q.r) - q.s * q.s, 2 * dot<double>(q.r, q.v),
        dot<double>(q.v, q.v) + dot<double>(q.r, q.a), dot<double>(q.v, q.a), dot<double>(q.a, q.a) / 4;
    const Eigen::PolynomialSolver<double, 4> solver(c);
    double first = kNever;
    for (const std::complex<double>& root : solver.roots()) {
        const double t = root.real();
        if (!(std::abs(root.imag()) <= 1e-9 * std::abs(t)) || !(t >= 0) || !(t < first)) continue;
        const double rate = c[1] + t * (2 * c[2] + t * (3 * c[3] + t * 4 * c[4]));
        if (rate < 0) first = t;
    }
    return first;
}

/// Nanoseconds a query; `sink` keeps the work from being dropped.
double nanoseconds(const std::vector<DiscQuery>& queries, double (*time_of)(const DiscQuery&), double& sink) {
    const auto start = std::chrono::steady_clock::now();
    for (const DiscQuery& q : queries) sink += std::min(time_of(q), 1.0);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    return took.count() / static_cast<double>(queries.size());
}

SpeedRow compare_on(const std::string& mix, const std::function<DiscQuery(test::Random&)>& make) {
    test::Random random(77);
    std::vector<DiscQuery> queries;
    while (queries.size() < kQueries) queries.push_back(make(random));
    SpeedRow row{mix, 0, kNever, kNever, 0};
    volatile double kept = 0;
    double sink = 0;
    for (int round = 0; round < kRounds; ++round) {
        row.carom_ns = std::min(row.carom_ns, nanoseconds(queries, carom_time, sink));
        row.eigen_ns = std::min(row.eigen_ns, nanoseconds(queries, eigen_time, sink));
    }
    kept = sink;
    (void)kept;
    for (const DiscQuery& q : queries) {
        const double t = carom_time(q);
        const double theirs = eigen_time(q);
        row.hits += t < kNever ? 1.0 / kQueries : 0;
        const bool same = t < kNever ? std::abs(theirs - t) <= 1e-9 * t : !(theirs < kNever);
        row.eigen_wrong += same ? 0 : 1.0 / kQueries;
    }
    return row;
}

}  // namespace

std::vector<SpeedRow> compare_speed() {
    std::vector<SpeedRow> rows;
    rows.push_back(compare_on("neighbours: 1 to 2 radii's sums apart, any motion", [](test::Random& random) {
        return DiscQuery{random.direction(random.uniform(1, 2)), random.direction(random.uniform(0.1, 2)),
                         random.direction(random.uniform(0.1, 2)), 1};
    }));
    rows.push_back(compare_on("neighbours that approach", [](test::Random& random) {
        DiscQuery q{random.direction(random.uniform(1, 2)), random.direction(random.uniform(0.1, 2)),
                    random.direction(random.uniform(0.1, 2)), 1};
        if (dot<double>(q.r, q.v) > 0) q.v = -q.v;
        return q;
    }));
    for (const DiscKind& kind : curved_kinds()) {
        if (kind.name == "four roots" || kind.name.starts_with("double graze"))
            rows.push_back(compare_on(kind.name, kind.make));
    }
    return rows;
}

}  // namespace carom::accuracy
