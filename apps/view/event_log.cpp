#include "event_log.hpp"

#include <algorithm>

namespace carom::app {

void EventLog::note(const Collision& c) {
    ++counts_[c.i];
    if (c.kind == CollisionKind::kBall) ++counts_[c.j];
    if (latest_.size() < kept_)
        latest_.push_back(c);
    else
        latest_[total_ % kept_] = c;
    ++total_;
}

std::vector<Collision> EventLog::history_of(std::uint32_t ball, std::size_t most) const {
    std::vector<Collision> history;
    for (std::uint64_t k = total_; k > total_ - latest_.size() && history.size() < most; --k) {
        const Collision& c = latest_[(k - 1) % kept_];
        if (c.i == ball || (c.kind == CollisionKind::kBall && c.j == ball)) history.push_back(c);
    }
    return history;
}

}  // namespace carom::app
