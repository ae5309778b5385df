// A failing scene made smaller while it still fails the same check.
#pragma once

#include <functional>

#include "examine.hpp"

namespace carom::stress {

/// Takes out edits, balls, walls and attractors, ends it earlier, and puts what is left back to its default,
/// as long as examine() still finds the same check broken. Stops where nothing more can go, or where
/// `may_go_on` says no. `verdict` is what examine() found, and becomes that of the smaller scene.
[[nodiscard]] Trial shrink(Trial trial, Verdict& verdict, const std::function<bool()>& may_go_on);

}  // namespace carom::stress
