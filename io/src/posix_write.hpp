// write(2) to its end.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>

namespace carom {

/// The mode of new files; the umask takes away what the user does not want.
inline constexpr mode_t kReadWriteAll = 0666;

/// What an errno means.
[[nodiscard]] std::string reason(int error_number);

/// Writes all of the text; gives the errno of what stopped it, else 0.
[[nodiscard]] int write_all(int descriptor, std::string_view text);

}  // namespace carom
