// Ctrl-C as a request to finish early.
#pragma once

namespace carom::app {

/// From now on the first SIGINT or SIGTERM only sets a flag; a second one ends the program at once.
void watch_for_interrupts();

/// Whether a signal has come.
[[nodiscard]] bool interrupt_requested();

}  // namespace carom::app
