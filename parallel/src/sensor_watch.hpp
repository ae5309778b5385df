// Follows all flights and tells which balls come into sensors and leave them. It looks on only: what it sees
// changes no bit of the balls' course.
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include <carom/broadphase/box_tree.hpp>
#include <carom/core/sensor_time.hpp>
#include <carom/parallel/world.hpp>

#include "bodies.hpp"
#include "engine.hpp"

namespace carom {

class SensorWatch {
 public:
    /// Balls that are in a sensor at `now`, up to which the engine has been advanced, are so without a word.
    /// `bodies` and `sensors` must outlive it.
    SensorWatch(const Bodies& bodies, const std::vector<Sensor>& sensors, const Engine& engine,
                const Time& now);

    /// Tells what has happened since the last time, until `to`, in the order of time; at one instant of the
    /// balls' ids.
    void take(const Engine& engine, const Stop& to, const std::function<void(const Sensing&)>& tell);
    /// The sensors that each ball is in, by its index.
    [[nodiscard]] const std::vector<std::vector<std::uint32_t>>& inside() const { return inside_; }
    /// Goes on with the same sensors and other bodies at the same time. Those that were left out, whose
    /// states were `before`, leave their sensors.
    void go_on_with(const Bodies& bodies, const Engine& engine, const Time& now,
                    const std::vector<BallState>& before, const std::function<void(const Sensing&)>& tell);

 private:
    /// A sensor near a flight and the stretches since its anchor in which the ball is there.
    struct Visit {
        std::uint32_t sensor;
        std::vector<Stretch> stretches;
    };
    struct Change {
        Time time;
        std::uint32_t rank;  ///< among the ball's changes
        Sensing sensing;
    };
    [[nodiscard]] std::vector<Visit> visits(std::uint32_t ball, const Flight& flight) const;
    void look_near(std::uint32_t ball, const Flight& flight, const Vec2& offset, const Box& way,
                   std::vector<Visit>& found) const;
    void follow(std::uint32_t ball, const Flight& flight, const Stop& to, std::vector<Change>& changes);
    void set(std::uint32_t ball, std::uint32_t sensor, bool enters, const Flight& flight, double since,
             std::vector<Change>& changes);
    void look(const Engine& engine, const Stop& to, std::vector<Change>& changes);

    const Bodies* bodies_;
    const std::vector<Sensor>& sensors_;
    Box all_;  ///< around all sensors
    BoxTree tree_;
    std::vector<std::vector<std::uint32_t>> inside_;  // rising
    Stop seen_;
    std::mutex mutex_;
};

}  // namespace carom
