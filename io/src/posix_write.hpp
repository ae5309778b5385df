// write(2) to its end.
#pragma once

#include <string>
#include <string_view>

namespace carom {

/// What an errno means.
[[nodiscard]] std::string reason(int error_number);

/// Writes all of the text; gives the errno of what stopped it, else 0.
[[nodiscard]] int write_all(int descriptor, std::string_view text);

}  // namespace carom
