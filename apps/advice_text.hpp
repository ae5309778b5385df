// What carom advise says: a table for people, JSON for programs, the command line to go on with.
#pragma once

#include <string>

#include <carom/core/scene.hpp>
#include <carom/trade/advice.hpp>

namespace carom::app {

/// What the user asked for.
struct AdviceRequest {
    std::string path;  ///< of the scene, as given
    Scene scene;       ///< as the file has it, its fills placed
    double error = 1e-3;
    double seconds = 30;
    double from = 0;  ///< simulated time at which the trials start
    int threads = 0;  ///< 0: not given
};

/// `carom run ...` that runs the scene with a setting that was tried.
[[nodiscard]] std::string command_of(const AdviceRequest& request, const Scene& setting);

[[nodiscard]] std::string table_of(const AdviceRequest& request, const trade::Advice& advice);
[[nodiscard]] std::string json_of(const AdviceRequest& request, const trade::Advice& advice);

}  // namespace carom::app
