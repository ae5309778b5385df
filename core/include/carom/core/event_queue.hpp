// The queue of next events: one time a ball, the earliest first.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace carom {

/// A calendar: keys of the coming stretch of time, the year, lie in the lists of its days, in no order; only
/// those of the day at hand are in a heap. A key beyond the year is in no list until its year comes.
///
/// An entry that has been changed since stays where it is and is dropped when its day comes. A year is as
/// long as brings about one event for two entries, so that a change costs the same however many there are.
/// Equal keys share a day, and of equals the smaller id comes first, so that the order of events is total.
class EventQueue {
 public:
    EventQueue() = default;
    /// `count` entries, all at infinity.
    explicit EventQueue(std::size_t count) { reset(count), rebuild(); }

    /// `count` entries, all at infinity, each to be put() before rebuild().
    void reset(std::size_t count) { slots_.assign(std::max<std::size_t>(count, 1), Slot{}); }

    /// One entry more, at infinity.
    void append() { slots_.emplace_back(); }

    /// Changes one key of many; call rebuild() before the next front(). Keys are no NaN.
    void put(std::uint32_t id, double key) { slots_[id] = {key, slots_[id].turn + 1}; }
    void rebuild() {
        year_length_ = 0;
        year_start_ = std::numeric_limits<double>::infinity();  // there is no last year
        start_year();
    }

    void set(std::uint32_t id, double key) {
        Slot& slot = slots_[id];
        slot.key = key;
        ++slot.turn;
        if (key < year_end_) enter(id, slot);
    }

    [[nodiscard]] double key(std::uint32_t id) const { return slots_[id].key; }
    /// The least key; infinity when nothing is to come.
    [[nodiscard]] double first_key() {
        find_first();
        return due_.empty() ? std::numeric_limits<double>::infinity() : due_.front().key;
    }

    /// The smallest id with the least key; any where nothing is to come.
    [[nodiscard]] std::uint32_t first() {
        return first([](std::uint32_t id) { return id; });
    }
    /// The id with the least key; of equals the one whose rank(id) is lowest.
    template <class Rank>
    [[nodiscard]] std::uint32_t first(Rank&& rank) {
        bool may_be_tied = false;
        std::uint32_t best = front(may_be_tied);
        if (may_be_tied) {
            for_each_first([&](std::uint32_t id) {
                if (rank(id) < rank(best)) best = id;
            });
        }
        return best;
    }
    /// An id with the least key. `may_be_tied` is set where more ids than one may have it, never left unset
    /// where they do.
    [[nodiscard]] std::uint32_t front(bool& may_be_tied) {
        find_first();
        if (due_.empty()) return 0;
        const Due& first = due_.front();
        may_be_tied =
            (due_.size() > 1 && due_[1].key == first.key) || (due_.size() > 2 && due_[2].key == first.key);
        return first.id;
    }

    /// An id that may well be the next one after the first; any where none is near.
    [[nodiscard]] std::uint32_t coming() const {
        constexpr std::size_t kDays = 3;
        if (due_.size() > 1) return due_[due_.size() > 2 && due_[2].key < due_[1].key ? 2 : 1].id;
        for (std::size_t day = day_; day < std::min(day_ + kDays, days_.size()); ++day)
            if (days_[day] != kNone) return entries_[static_cast<std::size_t>(days_[day])].id;
        return 0;
    }

    /// Years begun, each of which costs all entries, and entries held, those included that are stale.
    [[nodiscard]] std::uint64_t years() const { return years_; }
    [[nodiscard]] std::size_t entries() const { return entries_.size() + due_.size(); }

    /// Calls f(id) for every id whose key equals the least one. Costs their number.
    template <class F>
    void for_each_first(F&& f) {
        find_first();
        visit_equal(0, f);
    }

 private:
    struct Slot {
        double key = std::numeric_limits<double>::infinity();
        std::uint32_t turn = 0;  // counts its changes: what was entered before another one is stale
    };
    struct Entry {
        std::uint32_t id, turn;
        std::int32_t next;
    };
    struct Due {
        double key;
        std::uint32_t id, turn;
        friend bool operator<(const Due& a, const Due& b) {  // the heap's first is the least
            return a.key > b.key || (a.key == b.key && a.id > b.id);
        }
    };
    static constexpr std::int32_t kNone = -1;
    static constexpr std::size_t kMostStale = 4;  // entries an id, before the year is begun anew

    [[nodiscard]] std::size_t most_entries() const { return kMostStale * slots_.size() + 64; }
    [[nodiscard]] bool is_stale(std::uint32_t id, std::uint32_t turn) const {
        return slots_[id].turn != turn;
    }

    void enter(std::uint32_t id, const Slot& slot) {
        // Rounding may put what comes last beyond the year's end.
        const double day = std::min((slot.key - year_start_) * days_per_time_, last_day_);
        if (!(day >= next_day_)) {
            due_.push_back({slot.key, id, slot.turn});
            std::push_heap(due_.begin(), due_.end());
            is_overfull_ |= due_.size() > most_entries();
            ++events_;
            return;
        }
        std::int32_t& head = days_[static_cast<std::size_t>(day)];
        if (free_ == kNone) {
            entries_.push_back({id, slot.turn, head});
            is_overfull_ |= entries_.size() > most_entries();
            head = static_cast<std::int32_t>(entries_.size() - 1);
        } else {
            const std::int32_t spare = free_;
            Entry& entry = entries_[static_cast<std::size_t>(spare)];
            free_ = entry.next;
            entry = {id, slot.turn, head};
            head = spare;
        }
    }

    /// Brings the least entry to the front of the day at hand.
    void find_first() {
        if (is_overfull_) start_year();
        for (;;) {
            while (!due_.empty() && is_stale(due_.front().id, due_.front().turn)) {
                std::pop_heap(due_.begin(), due_.end());
                due_.pop_back();
            }
            if (!due_.empty() || !start_day()) return;
        }
    }

    /// False when nothing is to come.
    bool start_day() {
        while (day_ < days_.size() && days_[day_] == kNone) ++day_;
        if (day_ == days_.size()) return start_year() && start_day();
        std::int32_t& head = days_[day_++];
        next_day_ = static_cast<double>(day_);
        while (head != kNone) {
            Entry& entry = entries_[static_cast<std::size_t>(head)];
            if (!is_stale(entry.id, entry.turn)) due_.push_back({slots_[entry.id].key, entry.id, entry.turn});
            const std::int32_t next = entry.next;
            entry.next = free_;
            free_ = head;
            head = next;
        }
        events_ += due_.size();
        if (due_.size() > 1) std::make_heap(due_.begin(), due_.end());
        return true;
    }

    /// Enters what comes next, from the least key on. False when nothing is to come.
    [[gnu::noinline]] bool start_year() {
        ++years_;
        entries_.clear();
        due_.clear();
        is_overfull_ = false;
        free_ = kNone;
        days_.assign(std::max<std::size_t>(slots_.size() / 2, 1), kNone);
        double least = std::numeric_limits<double>::infinity();
        for (const Slot& slot : slots_) least = std::min(least, slot.key);
        if (least == std::numeric_limits<double>::infinity()) {
            year_end_ = -least;
            day_ = days_.size();
            return false;
        }
        year_length_ = next_length(least);
        year_start_ = least;
        events_ = 0;
        // Even where the length is less than an ulp of the start, the first entry is in the year.
        year_end_ =
            std::max(least + year_length_, std::nextafter(least, std::numeric_limits<double>::infinity()));
        days_per_time_ = static_cast<double>(days_.size()) / (year_end_ - year_start_);
        if (!std::isfinite(days_per_time_)) days_per_time_ = 0;
        last_day_ = static_cast<double>(days_.size() - 1);
        next_day_ = 0;
        day_ = 0;
        for (std::size_t id = 0; id < slots_.size(); ++id)
            if (slots_[id].key < year_end_) enter(static_cast<std::uint32_t>(id), slots_[id]);
        return true;
    }

    /// How long a year from `start` on is: by the last one's events, or by a sample of the keys; else as long
    /// as to the last one's start, so that few keys among many bring few years.
    [[nodiscard]] double next_length(double start) const {
        const double wanted = static_cast<double>(days_.size());
        if (year_length_ > 0) {
            const double change = wanted / std::max(1.0, static_cast<double>(events_));
            const double length = year_length_ * std::clamp(change, 0.25, 4.0);
            // Where few entries are ever due, the time that the last year took in all is short enough.
            return change > 4 ? std::max(length, start - year_start_) : length;
        }
        constexpr std::size_t kSample = 64;
        double sample[kSample];
        std::size_t taken = 0;
        const std::size_t stride = std::max<std::size_t>(1, slots_.size() / kSample);
        for (std::size_t id = 0; id < slots_.size() && taken < kSample; id += stride)
            if (slots_[id].key < std::numeric_limits<double>::infinity()) sample[taken++] = slots_[id].key;
        std::nth_element(sample, sample + taken / 2, sample + taken);
        const double length = taken > 0 ? sample[taken / 2] - start : 0;
        return length > 0 ? length : std::max(0.0, start - year_start_);
    }

    template <class F>
    void visit_equal(std::size_t place, F& f) {
        if (place >= due_.size() || due_[place].key != due_.front().key) return;
        if (!is_stale(due_[place].id, due_[place].turn)) f(due_[place].id);
        visit_equal(2 * place + 1, f);
        visit_equal(2 * place + 2, f);
    }

    std::vector<Slot> slots_;
    std::vector<std::int32_t> days_;  // the first entry of each
    std::vector<Entry> entries_;
    std::int32_t free_ = kNone;
    std::vector<Due> due_;      // a heap: the day at hand
    bool is_overfull_ = false;  // of what is stale
    std::size_t day_ = 0;       // the first that has not come
    double next_day_ = 0;       // the same
    double last_day_ = 0;
    std::size_t events_ = 0;  // entered in days of this year that have come
    double year_start_ = 0;
    double year_end_ = 0;
    double year_length_ = 0;
    double days_per_time_ = 0;
    std::uint64_t years_ = 0;
};

}  // namespace carom
