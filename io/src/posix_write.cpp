#include "posix_write.hpp"

#include <cerrno>
#include <system_error>

#include <unistd.h>

namespace carom {

std::string reason(int error_number) {
    return std::generic_category().message(error_number);
}

int write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

}  // namespace carom
