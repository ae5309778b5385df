// Whether sanitizers watch the program, which makes it ten times slower.
#pragma once

namespace carom::test {

/// Under sanitizers a test that repeats one thing often, for figures or for luck, may do so less often: they
/// look at every access, and the same ones come again and again.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace carom::test
