// What is measured as words of 64 bits, to be kept in a checkpoint and gone on with.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include <carom/core/vector.hpp>

namespace carom::observe {

// Both call each word in one order: words(number...) and words(list), for lists whose lengths both know.
class WordSink {
 public:
    explicit WordSink(std::vector<std::uint64_t>& words) : words_(words) {}
    template <class... T>
    void operator()(const T&... items) {
        (put(items), ...);
    }
    /// A number that the reader has to take as it is, as all of options.
    template <class T>
    void same(const T& number) {
        put(number);
    }

 private:
    void put(std::uint64_t number) { words_.push_back(number); }
    void put(bool truth) { words_.push_back(truth ? 1 : 0); }
    void put(double number) { words_.push_back(std::bit_cast<std::uint64_t>(number)); }
    void put(const Vec2& v) { (*this)(v.x(), v.y()); }
    template <class Items>
    void put(const Items& items) {
        for (const auto& item : items) put(item);
    }

    std::vector<std::uint64_t>& words_;
};

/// Throws std::invalid_argument where the words are of something else.
class WordSource {
 public:
    explicit WordSource(std::span<const std::uint64_t> words) : words_(words) {}
    template <class... T>
    void operator()(T&... items) {
        (take(items), ...);
    }
    template <class T>
    void same(const T& number) {
        T there{};
        take(there);
        if (there != number) fail();
    }
    /// How many items of so many words there may still be.
    [[nodiscard]] std::uint64_t most(std::uint64_t words) const { return words_.size() / words; }
    void require_end() const {
        if (!words_.empty()) fail();
    }
    [[noreturn]] static void fail() { throw std::invalid_argument("it was measured otherwise"); }

 private:
    void take(std::uint64_t& number) {
        if (words_.empty()) fail();
        number = words_.front();
        words_ = words_.subspan(1);
    }
    void take(bool& truth) {
        std::uint64_t number = 0;
        take(number);
        truth = number != 0;
    }
    void take(double& number) {
        std::uint64_t bits = 0;
        take(bits);
        number = std::bit_cast<double>(bits);
    }
    void take(Vec2& v) { (*this)(v.x(), v.y()); }
    template <class Items>
    void take(Items& items) {
        for (auto& item : items) take(item);
    }

    std::span<const std::uint64_t> words_;
};

}  // namespace carom::observe
