// The systems of the page's section on physics.
#include "accuracy/physics.hpp"

namespace carom::accuracy {
namespace {

PhysicsSystem gas(const std::string& name, std::size_t discs, double packing, double short_run,
                  double long_run, double largest_error) {
    return {packing < 0.4 ? "physics_gas" : "physics_dense",
            name,
            short_run,
            long_run,
            largest_error,
            [=](double length) { return periodic_gas({discs, packing, length, 5}); }};
}

PhysicsSystem velocities(const std::string& name, std::size_t discs, double short_run, double long_run) {
    return {"physics_velocities", name, short_run, long_run, 0, [=](double length) {
                return maxwell_distribution({discs, 0.3, length, 6});
            }};
}

PhysicsSystem walls(const std::string& name, const Mixture& mixture, double packing) {
    return {"physics_walls",
            name,
            1000,
            20000,
            0,
            [=](double length) { return walled_gas({1000, packing, length, 7}, mixture); }};
}

PhysicsSystem mixture(const std::string& name, const Mixture& mixture, double packing, double short_run,
                      double long_run) {
    return {"physics_mixtures", name, short_run, long_run, 0, [=](double length) {
                return periodic_mixture({1000, packing, length, 10}, mixture);
            }};
}

}  // namespace

// Short runs for seconds, long ones for a minute or two, at a million collisions of two discs a second. The
// errors asked for are 3e-4, of Z itself up to packing 0.3 and relative to Z above.
const std::vector<PhysicsSystem>& physics_systems() {
    static const std::vector<PhysicsSystem> systems = {
        gas("Gas10", 1024, 0.1, 3000, 20000, 3e-4),
        gas("Gas30", 1024, 0.3, 50000, 60000, 3e-4),
        gas("Gas30Small", 64, 0.3, 100000, 2000000, 0),
        {"physics_gas", "TwoDiscs", 64, 1024, 0,
         [](double runs) {
             std::vector<Figure> figures;
             for (const double packing : {0.1, 0.2, 0.35})  // the densest box is not five cells wide
                 figures.push_back(two_discs(packing, static_cast<int>(runs), 4000.0, 100));
             return figures;
         }},
        gas("Gas50", 1024, 0.5, 30000, 430000, 3e-4 * 4.1),
        gas("Gas65", 1024, 0.65, 40000, 150000, 3e-4 * 8.4),
        velocities("Velocities1000", 1000, 10000, 100000),
        velocities("Velocities16", 16, 50000, 1000000),
        walls("Walls30", kEqualDiscs, 0.3),
        walls("Walls60", kEqualDiscs, 0.6),
        walls("WallsMixture", kTwoSorts, 0.3),
        {"physics_gravity", "DiluteColumn", 1000, 12000, 0,
         [](double length) { return dilute_column({1000, 2e-4, length, 8}); }},
        {"physics_gravity", "DenseColumn", 40000, 200000, 0,
         [](double length) { return dense_column({800, 0.45, length, 9}); }},
        {"physics_cooling", "Haff", 100, 4000, 0,
         [](double runs) { return haff_cooling(400, static_cast<int>(runs), 9); }},
        mixture("Mixture1", kTwoSorts, 0.01, 4000, 40000),
        mixture("Mixture30", kTwoSorts, 0.3, 4000, 50000),
        mixture("UnevenMixture30", kUnevenSorts, 0.3, 4000, 50000)};
    return systems;
}

}  // namespace carom::accuracy
