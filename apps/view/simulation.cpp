#include "simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace carom::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void keep_last(std::vector<float>& curve, float value) {
    if (curve.size() == Curves::kLength) curve.erase(curve.begin());
    curve.push_back(value);
}

}  // namespace

Simulation::Simulation(Scene scene, const WorldOptions& options)
    : scene_(std::move(scene)), options_(options) {
    for (const Fill& fill : scene_.fills) seeds_.push_back(fill.seed);
    build();
}

void Simulation::build() {
    world_ = std::make_unique<World>(scene_, options_);
    log_ = std::make_unique<EventLog>(world_->ball_count());
    world_->on_collision([this](const Collision& c) {
        if (!seen_at_) seen_at_ = c.time;
        if (listens_) log_->note(c);
    });
    curves_ = {};
    thrown_at_.clear();
    refusal_.clear();
    since_sample_ = sampled_at_ = 0;
    sampled_collisions_ = 0;
    balls_ = world_->balls();
}

void Simulation::restart(std::uint64_t seed_shift) {
    for (std::size_t i = 0; i < seeds_.size(); ++i) scene_.fills[i].seed = seeds_[i] + seed_shift;
    looked_at_.reset();
    build();
}

void Simulation::play(double seconds, double speed, std::optional<double> budget) {
    // After a hiccup the world goes on from where it was, not from where it would be.
    constexpr double kLongestFrame = 0.1;
    const double span = (budget ? std::min(seconds, kLongestFrame) : seconds) * speed;
    const double target = world_->time() + span;
    if (!budget) {
        advance_to(target);
    } else {
        const auto start = Clock::now();
        while (world_->time() < target && seconds_since(start) < *budget) {
            const auto slice_start = Clock::now();
            const double from = world_->time();
            // SlicePace aims at 50 ms; a frame has room for a fraction of that.
            advance_to(std::min(target, from + std::max(pace_.slice() / 8, target * 1e-15)));
            pace_.took(world_->time() - from, seconds_since(slice_start));
        }
    }
    take_sample(seconds);
    after_moving();
}

void Simulation::advance_to(double time) {
    if (time > world_->time()) world_->advance_to(time);
}

void Simulation::after_moving() {
    balls_ = world_->balls();
}

void Simulation::take_sample(double seconds) {
    constexpr double kInterval = 0.05;  // real
    since_sample_ += seconds;
    const double passed = world_->time() - sampled_at_;
    if (since_sample_ < kInterval || !(passed > 0)) return;
    keep_last(curves_.energy, float(world_->energy()));
    keep_last(curves_.collision_rate, float(double(log_->total() - sampled_collisions_) / passed));
    since_sample_ = 0;
    sampled_at_ = world_->time();
    sampled_collisions_ = log_->total();
}

bool Simulation::play_one_event() {
    // Goes ahead in stretches until something happens, then back and to that time. A stretch is about the
    // time between two collisions, and longer each time that it brings none.
    constexpr double kFarthest = 1e9;
    const double start = world_->time();
    double stretch = log_->total() > 0 && start > 0 ? 2 * start / double(log_->total())
                                                    : 1e-3 * std::max(scene_.until, 1e-3);
    seen_at_.reset();
    for (; stretch < kFarthest * std::max(scene_.until, 1.0); stretch *= 2) {
        std::optional<Snapshot> before;
        if (scene_.method == Method::kEvent) before = world_->snapshot();
        listens_ = !before;
        world_->advance_to(world_->time() + stretch);
        listens_ = true;
        if (!seen_at_) continue;
        if (before) {
            const double when = std::max(*seen_at_, before->time);
            world_->restore(*before);
            const std::uint64_t total = log_->total();
            world_->advance_to(when);
            // The event's own time is finer than a double since time 0: it may lie within the last bit.
            if (log_->total() == total)
                world_->advance_to(std::nextafter(when, std::numeric_limits<double>::infinity()));
        }
        after_moving();
        return true;
    }
    after_moving();
    return false;
}

std::optional<std::uint32_t> Simulation::ball_at(const Vec2& place, double slack) const {
    std::optional<std::uint32_t> found;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < balls_.size(); ++i) {
        const double distance = (balls_[i].position - place).norm();
        if (distance > balls_[i].radius + slack || distance >= nearest) continue;
        nearest = distance;
        found = std::uint32_t(i);
    }
    return found;
}

std::optional<BallFacts> Simulation::facts() const {
    if (!looked_at_ || *looked_at_ >= balls_.size()) return std::nullopt;
    const std::uint32_t id = *looked_at_;
    BallFacts facts;
    facts.id = id;
    facts.ball = balls_[id];
    facts.collisions = log_->counts()[id];
    facts.next = next_meeting(balls_, id, scene_);
    facts.history = log_->history_of(id, 6);
    if (scene_.method == Method::kEvent && !facts.ball.is_static) {
        const auto place = std::count_if(balls_.begin(), balls_.begin() + std::ptrdiff_t(id),
                                         [](const Ball& ball) { return !ball.is_static; });
        facts.anchor = world_->snapshot().anchors[std::size_t(place)];
    }
    double last = facts.history.empty() ? 0 : facts.history.front().time;
    if (const auto thrown = thrown_at_.find(id); thrown != thrown_at_.end())
        last = std::max(last, thrown->second);
    facts.anchor_age = world_->time() - last;
    return facts;
}

template <class Edit>
bool Simulation::edit(Edit&& edit) {
    refusal_.clear();
    try {
        edit();
    } catch (const std::exception& e) {
        refusal_ = e.what();
        return false;
    }
    log_->grow(world_->ball_count());
    after_moving();
    return true;
}

bool Simulation::throw_ball(std::uint32_t ball, const Vec2& velocity) {
    return edit([&] {
        world_->set_velocity(ball, velocity);
        thrown_at_[ball] = world_->time();
    });
}

bool Simulation::add_ball(const Vec2& place) {
    Ball added;
    const auto moves = [](const Ball& b) { return !b.is_static; };
    if (looked_at_)
        added = balls_[*looked_at_];
    else if (const auto first = std::ranges::find_if(balls_, moves); first != balls_.end())
        added = *first;
    added.position = place;
    added.velocity = Vec2::Zero();
    return edit([&] { thrown_at_[world_->add_ball(added)] = world_->time(); });
}

bool Simulation::add_attractor(const Vec2& place) {
    const Box& box = world_->domain().box;
    const double reach = (box.max - box.min).norm() / 10;
    double speeds_squared = 0;
    for (const Ball& b : balls_) speeds_squared += b.velocity.squaredNorm();
    speeds_squared /= double(std::max<std::size_t>(balls_.size(), 1));
    speeds_squared = std::max(speeds_squared, world_->gravity().norm() * reach);
    if (!(speeds_squared > 0)) speeds_squared = reach * reach;  // all is at rest: any time will do
    // v^2 / 2 = k / reach
    std::vector<Attractor> attractors = world_->attractors();
    attractors.push_back({place, speeds_squared * reach / 2, reach / 10});
    return edit([&] { world_->set_attractors(attractors); });
}

}  // namespace carom::app
