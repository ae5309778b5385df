// Scenes as JSON text. The format is described in docs/scene-format.md and schemas/scene.schema.json.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <carom/core/scene.hpp>

namespace carom {

/// Reads a scene file and the balls file that it names, and checks both. A scene without a name takes the
/// file's. Throws SceneError, one line that says where and what: `balls[17].radius: must be > 0, is -1`; in
/// the balls file `snapshot.xyz:19: ...`, in text that is no JSON `line 3, column 7: ...`. Overlaps are not
/// looked for here.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path);

/// The same from text; a balls file is looked for relative to `folder`.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::filesystem::path& folder = {});

/// The scene as text that parse_scene turns into the same scene, bit for bit; what is at its default is left
/// out. Balls that came from a balls file stand among the others. Precondition: check(scene) passes.
[[nodiscard]] std::string write_scene(const Scene& scene);

}  // namespace carom
