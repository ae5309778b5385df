// A trajectory of text frames, one after the other.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <carom/io/growing_file.hpp>
#include <carom/io/trajectory.hpp>

namespace carom {

/// A frame to be appended as text.
struct TextFrame {
    std::uint64_t step;
    double time;
    std::span<const Ball> balls;
    const std::optional<Domain>& domain;
    Precision precision;
};

class TextTrajectory final : public Trajectory {
 public:
    using Append = void (*)(std::string& text, const TextFrame& frame);

    TextTrajectory(const std::filesystem::path& path, const KeptFrames& kept, Append append);
    void write(double time, std::span<const Ball> balls, const std::optional<Domain>& domain,
               Precision precision) override;
    /// The mark is the number of bytes.
    std::uint64_t sync() override;

 private:
    std::unique_ptr<GrowingFile> file_;
    std::uint64_t step_;
    Append append_;
    std::string text_;
};

}  // namespace carom
