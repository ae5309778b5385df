// A flag that a signal handler sets.
#include "interrupt.hpp"

#include <csignal>

namespace carom::app {
namespace {

volatile std::sig_atomic_t requested = 0;

constexpr int kSignals[] = {SIGINT, SIGTERM};

extern "C" void note_signal(int) {
    requested = 1;
    // std::signal with SIG_DFL is what the standard allows here besides the flag.
    for (const int signal : kSignals) std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interrupts() {
    struct sigaction action = {};
    action.sa_handler = note_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;  // a write to a file is not cut short
    for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

bool interrupt_requested() {
    return requested != 0;
}

}  // namespace carom::app
