// Which bytes of a checkpoint hold what, in one place for the reader and the writer.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <carom/io/checkpoint.hpp>

namespace carom::checkpoint_layout {

// Not ASCII at first and both ends of a line at last: what treats it as text shows.
inline constexpr std::string_view kMagic =
    "\x89"
    "CAROM\r\n";
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::size_t kNameSize = 16;  // of methods and sections, padded with zeros
/// Magic, version, number of sections, the file's size, scene hash, number of moving balls, method.
inline constexpr std::size_t kHeaderSize = 8 + 4 + 4 + 8 + 8 + 8 + kNameSize;
inline constexpr std::size_t kSectionHeaderSize = kNameSize + 8;
inline constexpr std::size_t kChecksumSize = 8;

template <class T, class Wanted>
concept Like = std::same_as<std::remove_const_t<T>, Wanted>;

// each(f, item) calls f for the item's numbers in the file's order, to read them or to change them.
template <class F, class T>
    requires std::is_arithmetic_v<T>
void each(F& f, T& number) {
    f(number);
}
template <class F, Like<Vec2> T>
void each(F& f, T& v) {
    f(v.x());
    f(v.y());
}
template <class F, Like<Time> T>
void each(F& f, T& t) {
    f(t.epoch);
    f(t.offset);
}
template <class F, Like<SavedAnchor> T>
void each(F& f, T& a) {
    each(f, a.position);
    each(f, a.velocity);
    each(f, a.time);
    f(a.periods_x);
    f(a.periods_y);
}
template <class F, Like<Counts> T>
void each(F& f, T& c) {
    f(c.ball_collisions);
    f(c.wall_collisions);
    f(c.events);
    f(c.windows);
    f(c.window_retries);
    f(c.copied_collisions);
}
template <class F, Like<SavedSum> T>
void each(F& f, T& s) {
    f(s.low);
    f(s.high);
    f(s.is_lost);
}
template <class F, Like<SavedContact> T>
void each(F& f, T& c) {
    f(c.ball);
    f(c.partner);
    f(c.image_x);
    f(c.image_y);
}
template <class F, Like<RunRecord> T>
void each(F& f, T& r) {
    f(r.energy_initial);
    each(f, r.momentum_initial);
    f(r.wall_seconds);
    f(r.trajectory_bytes);
    f(r.next_frame);
    f(r.frame_interval);
    f(r.events_bytes);
}

template <class F, Like<MeasuresRecord> T>
void each(F& f, T& m) {
    f(m.observables_bytes);
    f(m.next_sample);
    f(m.interval);
    f(m.last_sample);
}

/// Calls visitor.items(name, item...) for a section of a few items that is always there, visitor.list(name,
/// vector) for one of an item a moving ball, which may be absent, visitor.optional(name, item) for others,
/// among them vectors of any length.
template <class Visitor, Like<Checkpoint> T>
void for_each_section(Visitor& visitor, T& checkpoint) {
    auto& s = checkpoint.snapshot;
    visitor.items("moment", s.time, s.field_updates);
    visitor.items("counts", s.counts);
    visitor.items("virial", s.virial);
    visitor.list("anchors", s.anchors);
    visitor.list("last collisions", s.last_collisions);
    visitor.list("accelerations", s.accelerations);
    visitor.optional("steps", s.counts.steps);
    visitor.optional("missed", s.counts.missed_collisions);
    visitor.optional("contacts", s.contacts);
    visitor.optional("run", checkpoint.run);
    visitor.optional("sensings", checkpoint.sensings_bytes);
    visitor.optional("measures", checkpoint.measures);
    visitor.optional("observer", checkpoint.observer);
}

/// How many bytes a number takes: its own, and 8 for a truth value.
template <class T>
[[nodiscard]] constexpr std::size_t size_of_number() {
    return std::same_as<T, bool> ? 8 : sizeof(T);
}

/// How many bytes an item takes.
template <class T>
[[nodiscard]] std::size_t size_of() {
    std::size_t size = 0;
    auto count = [&size](const auto& number) {
        size += size_of_number<std::remove_cvref_t<decltype(number)>>();
    };
    const T item{};
    each(count, item);
    return size;
}

}  // namespace carom::checkpoint_layout
