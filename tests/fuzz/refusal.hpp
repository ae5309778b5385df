// The promise about errors: one line, printable, not endless.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

namespace carom::fuzz {

[[noreturn]] inline void broken(const char* promise, std::string_view what) {
    std::fprintf(stderr, "broken promise: %s: %.*s\n", promise, static_cast<int>(what.size()), what.data());
    std::abort();
}

inline void expect(bool holds, const char* promise, std::string_view what = {}) {
    if (!holds) broken(promise, what);
}

inline void expect_clear(std::string_view message) {
    constexpr std::size_t kLongest = 1000;
    expect(!message.empty(), "a refusal says something");
    expect(message.size() < kLongest, "a refusal is no longer than its reader's patience", message);
    for (const char c : message)
        expect(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "a refusal is one printable line",
               message);
}

/// Runs what may refuse with one of these errors; true where it did not.
template <class... Error, class Act>
bool taken(Act&& act) {
    const auto refuse = [](const std::exception& error) { expect_clear(error.what()); };
    try {
        try {
            act();
            return true;
        } catch (const std::exception& error) {
            if (!(... || (dynamic_cast<const Error*>(&error) != nullptr)))
                broken("a refusal is of the kind that the header names", error.what());
            refuse(error);
        }
    } catch (...) {
        broken("what is thrown is a std::exception", "");
    }
    return false;
}

}  // namespace carom::fuzz
