// What somebody may have meant who wrote a word that is not known.
#pragma once

#include <span>
#include <string_view>

namespace carom {

/// The known word with the fewest insertions, deletions, replacements and swaps of neighbouring letters from
/// `word`, the first of equals; empty where all are too far: more than two of them and more than a third of
/// its length, or where it is longer than 40 letters.
[[nodiscard]] std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);

}  // namespace carom
