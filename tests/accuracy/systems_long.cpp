// Some ten million collisions.
#include "accuracy/systems.hpp"

namespace carom::accuracy {

std::vector<System> long_systems() {
    return {};
}

}  // namespace carom::accuracy
