// Observer: what statistical mechanics asks of a world, measured while it moves. It reads and changes
// nothing: the world's bits are the same with it and without.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <carom/parallel/world.hpp>

namespace carom {

struct ObserverOptions {
    /// Whether every collision is passed to record(); only then are there pressures of the walls.
    bool records_collisions = false;
    double average_from = 0;  ///< samples before this time are left out of structure()
    double reach = 5;         ///< of the radial distribution, in mean diameters
    double bin = 0.05;        ///< of the radial distribution, in mean diameters
    std::size_t profile_bins = 100;
    std::size_t lags = 64;  ///< of the correlations in time, in samples; 0: none are kept
    /// Balls that the correlations follow, evenly spread over the ids; memory is 32 bytes * lags * this.
    std::size_t tracked = 16384;
    /// Two balls nearer than this are neighbours in the hexatic order. 0: (1 + sqrt 3) / 2 = 1.366 spacings
    /// of the triangular lattice of the box's density, half-way between its first and its second neighbours.
    double neighbour_cutoff = 0;
    bool hexatic = true;    ///< whether samples have the hexatic order, which costs a search of neighbours
    bool structure = true;  ///< whether structure() is wanted, which costs another
};

/// One moment. Rates and pressures are means over the time since the sample before; none in the first. All of
/// it is about the moving balls.
struct Sample {
    double time = 0;
    double kinetic_energy = 0;
    /// k T: the kinetic energy a degree of freedom, times two. Where nothing holds the centre of mass (no
    /// walls, no static balls) its motion is left out. None where no degree of freedom is left.
    std::optional<double> temperature;
    /// N k T / A + sum of r_ij . impulse / (2 A t), A the box's area; of boxes periodic on both axes.
    std::optional<double> pressure;
    /// Momentum that the domain's walled sides took up, a length and time: left, right, bottom, top.
    std::array<std::optional<double>, 4> wall_pressure;
    std::optional<double> ball_collision_rate;  ///< of all balls, a time
    std::optional<double> wall_collision_rate;
    std::optional<double> mean_free_path;  ///< mean speed over the rate of a ball's collisions with balls
    double mean_square_displacement = 0;   ///< since the first sample; periodic sides are passed through
    std::optional<double> hexatic_global;  ///< |mean of psi_6|, see Observer
    std::optional<double> hexatic_local;   ///< mean of |psi_6|
};

struct Curve {
    std::vector<double> at;
    std::vector<double> value;
};

/// Means over the samples from average_from on. A curve that the world has none of is empty.
struct Structure {
    std::uint64_t samples = 0;
    double first_time = 0;
    double last_time = 0;
    double mean_diameter = 0;
    Curve radial_distribution;  ///< g at the bins' middles; an ideal gas has 1. None in an open domain
    Curve density_x;            ///< balls an area in slices of the domain's box, at the slices' middles
    Curve density_y;
    Curve mean_square_displacement;  ///< over the lag, from all samples as origins; equal lags only
    Curve velocity_autocorrelation;  ///< mean of v(t) . v(t + lag)
};

/// Fed with a world between its steps. psi_6 of a ball is the mean of exp(6 i theta) over its neighbours,
/// theta the direction to them; 0 where it has none (Nelson and Halperin 1979). The radial distribution
/// reaches to half the shortest period, or to a quarter of a walled box, and takes the circles that lie in
/// the box whole; it is normalised by the mean density of the box. One thread at a time.
class Observer {
 public:
    explicit Observer(const World& world, const ObserverOptions& options = {});
    ~Observer();
    Observer(Observer&&) noexcept;
    Observer& operator=(Observer&&) noexcept;

    /// To be called for each collision where the options say so: world.on_collision([&](auto& c) {
    /// observer.record(c); }).
    void record(const Collision& collision);
    /// The world as it is now. Cost: a few passes over the balls, and the searches of neighbours. Throws
    /// std::invalid_argument where the number of balls has changed or the time has not grown.
    Sample sample(const World& world);
    [[nodiscard]] Structure structure() const;

    /// All that has been measured so far, for another observer of the same world and options to go on from
    /// with the same bits: words whose meaning is the library's own. Up to 32 bytes * lags * tracked.
    [[nodiscard]] std::vector<std::uint64_t> save() const;
    /// Throws std::invalid_argument where the words were saved with other options or for another number of
    /// balls; the observer is of no use then.
    void restore(std::span<const std::uint64_t> words);

 private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace carom
