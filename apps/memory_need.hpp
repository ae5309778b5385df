// How much memory a scene will take and how much there is, so that one too large is refused before the work.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <carom/core/scene.hpp>

namespace carom::app {

/// Bytes that World takes for a scene on top of the scene itself, with a margin: see the constants' figures.
[[nodiscard]] double memory_need(const Scene& scene);

/// Balls of the scene with those of its fills.
[[nodiscard]] double count_of_balls(const Scene& scene);

/// What is left to take, and what says so.
struct MemoryRoom {
    double bytes = 0;
    std::string limit;  ///< "free memory", "the limit of the address space (ulimit -v)"
};

/// The least of what the machine has free, the process's limits and its control groups leave; none where
/// nothing of it can be read.
[[nodiscard]] std::optional<MemoryRoom> memory_room();

/// What the control groups (version 2) leave: of all groups from the process's own, `group`, up to the root
/// in whose folder they stand.
[[nodiscard]] std::optional<double> room_of_groups(const std::filesystem::path& root,
                                                   const std::string& group);

/// Throws std::runtime_error, one line with both figures, where a scene needs more than there is.
void require_memory(const Scene& scene);

}  // namespace carom::app
