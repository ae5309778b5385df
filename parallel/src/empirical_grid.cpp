// Counting sort of points into cells.
#include "empirical_grid.hpp"

namespace carom {

void EmpiricalGrid::sort(std::span<const double> xs, std::span<const double> ys,
                         std::span<const std::uint8_t> left_out, const Executor& executor) {
    const std::size_t n = xs.size();
    cell_.resize(n);
    executor.for_ranges(n, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) cell_[i] = cell(xs[i], ys[i]);
    });
    first_.assign(static_cast<std::size_t>(cell_count()) + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        if (!left_out.empty() && left_out[i] != 0) cell_[i] = -1;
        if (cell_[i] >= 0) ++first_[static_cast<std::size_t>(cell_[i])];
    }
    std::uint32_t total = 0;
    for (std::uint32_t& f : first_) {  // the end of each cell, which filling from behind turns into its first
        total += f;
        f = total;
    }
    numbers_.resize(total);
    sorted_x_.resize(total);
    sorted_y_.resize(total);
    for (std::size_t i = n; i-- > 0;) {
        if (cell_[i] < 0) continue;
        const std::uint32_t k = --first_[static_cast<std::size_t>(cell_[i])];
        numbers_[k] = static_cast<std::uint32_t>(i);
        sorted_x_[k] = xs[i];
        sorted_y_[k] = ys[i];
    }
}

std::array<EmpiricalGrid::Near, 9> EmpiricalGrid::around(std::int32_t c) const {
    const std::int32_t x = c % x_.count();
    const std::int32_t y = c / x_.count();
    constexpr std::array<std::pair<int, int>, 9> kSteps = {
        {{0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}, {-1, 0}, {1, -1}, {0, -1}, {-1, -1}}};
    std::array<Near, 9> all;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const CellAxis::Seen sx = x_.seen(x + kSteps[k].first);
        const CellAxis::Seen sy = y_.seen(y + kSteps[k].second);
        all[k] = {sy.cell * x_.count() + sx.cell, sx.shift, sy.shift};
    }
    return all;
}

}  // namespace carom
