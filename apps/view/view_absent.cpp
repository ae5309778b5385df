// In place of the window in a program that was built without it.
#include <stdexcept>

#include "view_loop.hpp"

namespace carom::app {

int view(const ViewOptions&) {
    throw std::runtime_error(
        "this program was built without its window; install libsdl2-dev and libimgui-dev, configure with "
        "CAROM_BUILD_VIEW=ON and build again");
}

}  // namespace carom::app
