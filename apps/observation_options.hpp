// Options of `carom run` for what it measures.
#pragma once

#include <CLI/CLI.hpp>

#include "run.hpp"

namespace carom::app {

void add_observation_options(CLI::App& command, ObservationOptions& options);

/// Throws CLI::Error (wrong usage) where --every has nothing to do, or what needs it is without; and where a
/// run that is to be gone on with measures.
void require_fitting(const RunOptions& options);

}  // namespace carom::app
