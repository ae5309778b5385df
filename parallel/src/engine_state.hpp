// What an engine starts from, and how it gives its balls: from a scene or a snapshot, to a snapshot.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <carom/core/snapshot.hpp>

#include "ball_record.hpp"
#include "bodies.hpp"
#include "executor.hpp"

namespace carom {

/// The moving balls as all have been advanced to one time, without predictions.
struct EngineStart {
    std::vector<BallRecord> records;
    std::vector<BallExtra> extras;  ///< one a record where the scene needs them
    Time now;
    bool has_field = false;  ///< whether the extras hold the attractors' accelerations already
    Counts counts;
    SavedSum virial;
    std::optional<std::vector<SavedContact>> contacts;  ///< of the empirical method, where they are known
};

/// The scene's beginning.
[[nodiscard]] EngineStart start_at_zero(const Bodies& bodies, std::span<const Ball> balls);

/// Throws SnapshotError where the snapshot's balls are not those of the scene, or are in no state that the
/// engine could have left them in.
[[nodiscard]] EngineStart start_from(const Bodies& bodies, const Snapshot& snapshot,
                                     const Executor& executor);

/// Takes moving balls in any order, from any thread, one call a ball.
class BallSaver {
 public:
    BallSaver(const Bodies& bodies, Snapshot& snapshot);
    void save(std::uint32_t id, const Anchor& anchor, const Periods& periods, const BallExtra& extra);

 private:
    Snapshot& snapshot_;
    std::vector<std::uint32_t> ranks_;  // among the moving balls; empty where all move
};

}  // namespace carom
