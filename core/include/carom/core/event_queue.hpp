// The queue of next events: one time a ball, the earliest first.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace carom {

/// A calendar: keys of the coming stretch of time, the year, lie in its days, four places a day, in no order.
/// A key beyond the year is in no day until its year comes.
///
/// One bit a place tells which are taken, so that the day at hand is the first with a bit set, and a key that
/// changes is taken out at once, by its bit. What finds its day full goes to a heap, the crowd, which is
/// rare. A year has a day for each entry, and is as long as brings about one event a day, so that a change
/// costs the same however many entries there are. Nothing branches on where entries lie, for that cannot be
/// foreseen; and the first entry is looked for when the one before it is taken, so that nobody waits for it.
/// Equal keys share a day or the crowd, and of equals the smaller id comes first, so that the order of events
/// is total.
class EventQueue {
 public:
    EventQueue() = default;
    /// `count` entries, all at infinity.
    explicit EventQueue(std::size_t count) { reset(count), rebuild(); }

    /// `count` entries, all at infinity, each to be put() before rebuild().
    void reset(std::size_t count) { slots_.assign(std::max<std::size_t>(count, 1), Slot{}); }

    /// One entry more, at infinity.
    void append() { slots_.push_back({.place = outside_}); }

    /// Changes one key of many; call rebuild() before the next front(). Keys are no NaN.
    void put(std::uint32_t id, double key) { slots_[id].key = key; }
    void rebuild() {
        year_length_ = 0;
        year_start_ = std::numeric_limits<double>::infinity();  // there is no last year
        start_year();
    }

    void set(std::uint32_t id, double key) {
        clear(slots_[id].place);
        slots_[id].key = key;
        if (id == first_.id || key <= first_.key) [[unlikely]]
            is_known_ = false;
        enter(id, key);
    }
    /// Takes an entry out, which is at infinity until it is set: the first one as a rule.
    void take(std::uint32_t id) {
        clear(std::exchange(slots_[id].place, outside_));
        slots_[id].key = kNever;
        ++events_;
        is_known_ = find_near();
    }

    [[nodiscard]] double key(std::uint32_t id) const { return slots_[id].key; }
    /// The least key; infinity when nothing is to come.
    [[nodiscard]] double first_key() { return front().key; }

    /// The smallest id with the least key; any where nothing is to come.
    [[nodiscard]] std::uint32_t first() {
        return first([](std::uint32_t id) { return id; });
    }
    /// The id with the least key; of equals the one whose rank(id) is lowest.
    template <class Rank>
    [[nodiscard]] std::uint32_t first(Rank&& rank) {
        const Front least = front();
        std::uint32_t best = least.id;
        if (least.other != least.id || least.may_be_more) {
            for_each_first([&](std::uint32_t id) {
                if (rank(id) < rank(best)) best = id;
            });
        }
        return best;
    }
    struct Front {
        std::uint32_t id = 0;     ///< any where nothing is to come
        std::uint32_t other = 0;  ///< another one that had the key when it was looked for; else the same
        double key = std::numeric_limits<double>::infinity();
        bool may_be_more = false;  ///< set where yet others may have the key, and always where they do
    };
    /// An id with the least key.
    [[nodiscard]] Front front() {
        if (!is_known_) [[unlikely]]
            find_first();
        return first_;
    }
    /// What the next front() will give, but for what is set before; any where that is not known.
    [[nodiscard]] std::uint32_t coming() const { return first_.id; }

    /// One of the next day with entries after that one's; any where none is near.
    [[nodiscard]] std::uint32_t coming_later() const {
        constexpr std::uint64_t kOne = 1;
        const std::uint64_t word = taken_[word_];
        const unsigned day = static_cast<unsigned>(std::countr_zero(word | kOne)) / kPlaces * kPlaces;
        const std::uint64_t rest = word & ~(((kOne << kPlaces) - 1) << day);
        const auto place = static_cast<unsigned>(std::countr_zero(rest != 0 ? rest : kOne));
        return id_at(word_ * kBits + place) & -std::uint32_t{rest != 0};
    }
    /// Asks for the memory of an entry ahead of its use.
    void fetch(std::uint32_t id) const { __builtin_prefetch(&slots_[id]); }

    /// Years begun, each of which costs all entries.
    [[nodiscard]] std::uint64_t years() const { return years_; }
    /// Entries held in the year, and those of them in the crowd, where some may be stale.
    [[nodiscard]] std::size_t entries() const {
        std::size_t sum = crowd_.size();
        for (const std::uint64_t word : taken_) sum += static_cast<std::size_t>(std::popcount(word));
        return sum;
    }
    [[nodiscard]] std::size_t crowd() const { return crowd_.size(); }

    /// Calls f(id) for every id whose key equals the least one. Costs their number.
    template <class F>
    void for_each_first(F&& f) {
        find_first();
        if (!is_known_) return;
        const double least = first_.key;
        if (taken_[word_] != 0) {
            const std::size_t first = first_place();
            for (unsigned tied = lanes_at(first, least); tied != 0; tied &= tied - 1)
                f(id_at(first + std::size_t(std::countr_zero(tied))));
        }
        visit_equal(0, least, f);
    }

 private:
    static constexpr double kNever = std::numeric_limits<double>::infinity();
    constexpr static unsigned kPlaces = 4;  // a day
    static constexpr unsigned kBits = 64;
    struct Slot {
        double key = kNever;
        std::uint32_t place = 0;  // in the year's days, or beyond them
        std::uint32_t turn = 0;   // in the crowd: what was entered before another one is stale
    };
    struct alignas(kPlaces * sizeof(double)) Day {
        double keys[kPlaces];
    };
    struct Crowded {
        double key;
        std::uint32_t id, turn;
        friend bool operator<(const Crowded& a, const Crowded& b) {  // the heap's first is the least
            return a.key > b.key;
        }
    };
    using Keys __attribute__((vector_size(sizeof(Day)))) = double;
    using Masks __attribute__((vector_size(sizeof(Day)))) = std::int64_t;
    static constexpr std::size_t kMostCrowded = 4;  // entries an id, before the year is begun anew

    [[nodiscard]] std::uint32_t id_at(std::size_t place) const {
        return ids_[place / kPlaces][place % kPlaces];
    }
    [[nodiscard]] bool is_stale(const Crowded& entry) const {
        const Slot& slot = slots_[entry.id];
        return slot.place != in_crowd_ || slot.turn != entry.turn;
    }

    void enter(std::uint32_t id, double key) {
        const bool is_in = key < year_end_;
        // Rounding may put what comes last beyond the year's end, and what comes first before its start.
        const double passed = (key - year_start_) * days_per_time_;
        const double day = passed < last_day_ ? passed : last_day_;
        const std::uint32_t first =
            kPlaces * static_cast<std::uint32_t>(static_cast<std::int32_t>(day > 0 ? day : 0));
        const unsigned taken = (taken_[first / kBits] >> first % kBits) & ((1U << kPlaces) - 1);
        if (taken == (1U << kPlaces) - 1 && is_in) [[unlikely]]
            return enter_crowd(id, key);
        const std::uint32_t inside = first + static_cast<unsigned>(std::countr_zero(~taken));
        const std::uint32_t place = outside_ ^ ((outside_ ^ inside) & -std::uint32_t{is_in});
        days_[place / kPlaces].keys[place % kPlaces] = key;
        ids_[place / kPlaces][place % kPlaces] = id;
        taken_[place / kBits] |= std::uint64_t{is_in} << place % kBits;
        if (place / kBits < word_) [[unlikely]]
            word_ = place / kBits;
        slots_[id].place = place;
    }

    [[gnu::noinline]] void enter_crowd(std::uint32_t id, double key) {
        slots_[id].place = in_crowd_;
        crowd_.push_back({key, id, ++slots_[id].turn});
        std::push_heap(crowd_.begin(), crowd_.end());
        crowd_key_ = crowd_.front().key;
        if (is_overcrowded()) is_known_ = false;  // find_first() sees to it
    }
    [[nodiscard]] bool is_overcrowded() const { return crowd_.size() > kMostCrowded * slots_.size() + 64; }

    void clear(std::uint32_t place) { taken_[place / kBits] &= ~(std::uint64_t{1} << place % kBits); }

    /// The first place of the day at hand. Precondition: one is taken in `word_`.
    [[nodiscard]] std::size_t first_place() const {
        return word_ * kBits + std::size_t(std::countr_zero(taken_[word_])) / kPlaces * kPlaces;
    }
    /// Reads the keys of the day whose places begin at `first`, infinity where none is. No vector is passed
    /// by value: how depends on the instruction set.
    void read(std::size_t first, Keys& keys) const {
        const Masks bits = Masks{} + static_cast<std::int64_t>(taken_[first / kBits] >> first % kBits);
        std::memcpy(&keys, days_[first / kPlaces].keys, sizeof(keys));
        keys = (bits & Masks{1, 2, 4, 8}) != 0 ? keys : Keys{} + kNever;
    }
    [[nodiscard]] Front least_of_day(std::size_t first) const {
        Keys keys;
        read(first, keys);
        const double least = std::min(std::min(keys[0], keys[1]), std::min(keys[2], keys[3]));
        const unsigned bits = bits_of(keys == Keys{} + least);
        const unsigned others = bits & (bits - 1);
        const auto lane = std::size_t(std::countr_zero(bits));
        const auto other = std::size_t(std::countr_zero(others != 0 ? others : bits));
        return {id_at(first + lane), id_at(first + other), least, (others & (others - 1)) != 0};
    }
    /// One bit for each place of that day whose key is `key`.
    [[nodiscard]] unsigned lanes_at(std::size_t first, double key) const {
        Keys keys;
        read(first, keys);
        return bits_of(keys == Keys{} + key);
    }
    [[nodiscard]] static unsigned bits_of(const Masks& masks) {
#ifdef __AVX__
        return static_cast<unsigned>(_mm256_movemask_pd(std::bit_cast<__m256d>(masks)));
#else
        std::int64_t lanes[kPlaces];
        std::memcpy(lanes, &masks, sizeof(lanes));
        unsigned bits = 0;
        for (unsigned k = 0; k < kPlaces; ++k) bits |= static_cast<unsigned>(lanes[k] & 1) << k;
        return bits;
#endif
    }

    /// The first entry, where it is in one of the next days. Precondition: it is in no day before.
    bool find_near() {
        if (taken_[word_] == 0) word_ = std::min(word_ + 1, taken_.size() - 1);
        if (taken_[word_] == 0) return false;
        first_ = least_of_day(first_place());
        return first_.key < crowd_key_;
    }

    [[gnu::noinline]] void find_first() {
        if (is_overcrowded()) start_year();
        is_known_ = true;
        for (;;) {
            while (word_ < taken_.size() - 1 && taken_[word_] == 0) ++word_;
            if (find_near()) return;
            while (!crowd_.empty() && is_stale(crowd_.front())) {
                std::pop_heap(crowd_.begin(), crowd_.end());
                crowd_.pop_back();
            }
            crowd_key_ = crowd_.empty() ? kNever : crowd_.front().key;
            const double day_key = taken_[word_] == 0 ? kNever : first_.key;
            if (day_key < crowd_key_) return;
            if (!crowd_.empty()) {
                const auto is_next = [this](std::size_t k) {
                    return k < crowd_.size() && crowd_[k].key == crowd_key_;
                };
                const std::uint32_t id = crowd_.front().id;
                first_ = {id, id, crowd_key_, day_key == crowd_key_ || is_next(1) || is_next(2)};
                return;
            }
            first_ = {};
            is_known_ = start_year();
            if (!is_known_) return;
        }
    }

    /// Enters what comes next, from the least key on. False when nothing is to come.
    [[gnu::noinline]] bool start_year() {
        ++years_;
        const std::size_t days = std::max<std::size_t>(slots_.size(), 1);
        outside_ = static_cast<std::uint32_t>(days) * kPlaces;
        in_crowd_ = outside_ + 1;
        days_.resize(days + 1);  // one for what is outside
        ids_.resize(days + 1);
        taken_.assign(in_crowd_ / kBits + 1, 0);
        crowd_.clear();
        crowd_key_ = kNever;
        is_known_ = false;
        word_ = taken_.size() - 1;
        last_day_ = static_cast<double>(days - 1);
        double least = kNever;
        for (Slot& slot : slots_) {
            least = std::min(least, slot.key);
            slot.place = outside_;
        }
        if (least == kNever) {
            year_end_ = -kNever;
            return false;
        }
        year_length_ = next_length(least, static_cast<double>(days));
        year_start_ = least;
        events_ = 0;
        // Even where the length is less than an ulp of the start, the first entry is in the year.
        year_end_ = std::max(least + year_length_, std::nextafter(least, kNever));
        days_per_time_ = static_cast<double>(days) / (year_end_ - year_start_);
        if (!std::isfinite(days_per_time_)) days_per_time_ = 0;
        constexpr std::size_t kStretch = 256;
        std::array<std::uint32_t, kStretch> in_year;
        for (std::size_t first = 0; first < slots_.size(); first += kStretch) {
            const std::size_t last = std::min(first + kStretch, slots_.size());
            std::size_t count = 0;
            for (std::size_t id = first; id < last; ++id) {
                in_year[count] = static_cast<std::uint32_t>(id);
                count += slots_[id].key < year_end_ ? 1 : 0;
            }
            for (std::size_t k = 0; k < count; ++k) enter(in_year[k], slots_[in_year[k]].key);
        }
        return true;
    }

    /// How long a year from `start` on is that is to bring so many events: by the last one's, or by a sample
    /// of the keys; else as long as to the last one's start, so that few keys among many bring few years.
    [[nodiscard]] double next_length(double start, double wanted) const {
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
            if (slots_[id].key < kNever) sample[taken++] = slots_[id].key;
        std::nth_element(sample, sample + taken / 2, sample + taken);
        const double length = taken > 0 ? sample[taken / 2] - start : 0;
        return length > 0 ? length : std::max(0.0, start - year_start_);
    }

    template <class F>
    void visit_equal(std::size_t at, double key, F& f) {
        if (at >= crowd_.size() || crowd_[at].key != key) return;
        if (!is_stale(crowd_[at])) f(crowd_[at].id);
        visit_equal(2 * at + 1, key, f);
        visit_equal(2 * at + 2, key, f);
    }

    std::vector<Slot> slots_;
    std::vector<Day> days_;
    std::vector<std::array<std::uint32_t, kPlaces>> ids_;  // whose the keys are
    std::vector<std::uint64_t> taken_;                     // one bit a place
    std::vector<Crowded> crowd_;                           // a heap: what found its day full
    double crowd_key_ = kNever;                            // the least in it, of a stale one perhaps
    std::uint32_t outside_ = 0;                            // the place of those beyond the year, never taken
    std::uint32_t in_crowd_ = 1;                           // of those in the crowd
    std::size_t word_ = 0;                                 // of `taken_`: none is taken before it
    Front first_;                                          // where it is known
    bool is_known_ = false;
    std::size_t events_ = 0;  // taken in this year
    double last_day_ = 0;
    double year_start_ = 0;
    double year_end_ = 0;
    double year_length_ = 0;
    double days_per_time_ = 0;
    std::uint64_t years_ = 0;
};

}  // namespace carom
