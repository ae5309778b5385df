// All that must hold of any scene, checked on one: several worlds of it, cut, framed and resumed differently,
// must show the same bits, and each must obey physics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

namespace carom::stress {

/// A scene whose fills are placed, and the seed of how it is edited, cut, framed and resumed.
struct Trial {
    Scene scene;
    std::uint64_t seed = 1;
    int threads = 2;
    std::vector<std::uint32_t> edits = {};  ///< numbers of those that take place, see edits.hpp
};

struct Verdict {
    std::string check;   ///< that failed: one word or two; empty where all held
    std::string detail;  ///< where and by how much, one line
    double time = 0;     ///< simulated, up to which all or the failure was looked at
    std::uint64_t collisions = 0;
    bool is_cut = false;      ///< the scene was left early, for it collides too often
    bool is_refused = false;  ///< the engine says that the scene leads nowhere, as documented

    [[nodiscard]] bool failed() const { return !check.empty(); }
};

[[nodiscard]] Verdict examine(const Trial& trial);

}  // namespace carom::stress
