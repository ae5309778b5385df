// Time as (epoch, offset): one double loses digits on long runs, an epoch count beside it does not.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace carom {

/// A point in time: epoch * length + offset, with 0 <= offset < length. The length belongs to the Clock.
struct Time {
    std::int64_t epoch = 0;
    double offset = 0;

    friend bool operator==(const Time&, const Time&) = default;
    friend bool operator<(const Time& a, const Time& b) {
        return a.epoch == b.epoch ? a.offset < b.offset : a.epoch < b.epoch;
    }
    friend bool operator>(const Time& a, const Time& b) { return b < a; }
    friend bool operator<=(const Time& a, const Time& b) {
        return a.epoch == b.epoch ? a.offset <= b.offset : a.epoch < b.epoch;
    }
    friend bool operator>=(const Time& a, const Time& b) { return b <= a; }
};

/// A time that never comes.
inline constexpr Time kNever{std::numeric_limits<std::int64_t>::max(),
                             std::numeric_limits<double>::infinity()};

/// Adds and subtracts times. The epoch's length is a power of two, so that multiples of it are exact. All
/// members are pure functions.
class Clock {
 public:
    Clock() = default;
    /// The epoch is the largest power of two that is at most `length_hint`. Precondition: length_hint is
    /// finite and > 0.
    explicit Clock(double length_hint)
        : length_(std::exp2(std::floor(std::log2(length_hint)))), inverse_(1 / length_) {}

    [[nodiscard]] double epoch_length() const { return length_; }

    /// later - earlier. Exact to one rounding when both lie in one epoch.
    [[nodiscard]] double difference(const Time& later, const Time& earlier) const {
        const double within = later.offset - earlier.offset;
        return later.epoch == earlier.epoch
                   ? within
                   : within + length_ * (double(later.epoch) - double(earlier.epoch));
    }

    /// The time `duration` >= 0 after `t`; kNever when that is beyond the last epoch.
    [[nodiscard]] Time after(const Time& t, double duration) const {
        const double offset = t.offset + duration;
        if (offset < length_) return {t.epoch, offset};
        return normalised(t.epoch, offset);
    }

    /// Seconds from `base`'s start to `t`: exact for t within that epoch, rounded but in order beyond it.
    [[nodiscard]] double since_epoch(const Time& t, std::int64_t base) const {
        return t.epoch == base ? t.offset : t.offset + length_ * (double(t.epoch) - double(base));
    }

    [[nodiscard]] Time from_seconds(double seconds) const { return after({}, seconds); }
    [[nodiscard]] double to_seconds(const Time& t) const { return since_epoch(t, 0); }

 private:
    [[nodiscard]] Time normalised(std::int64_t epoch, double offset) const {
        const double epochs = std::floor(offset * inverse_);
        if (!(double(epoch) + epochs < kEpochs)) return kNever;
        return {static_cast<std::int64_t>(double(epoch) + epochs), offset - epochs * length_};
    }

    static constexpr double kEpochs = 0x1p52;  // so many and their differences are exact in double
    double length_ = 1;
    double inverse_ = 1;
};

}  // namespace carom
