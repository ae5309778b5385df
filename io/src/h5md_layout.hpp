// Where what stands in an H5MD file of Carom's.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <carom/core/scene.hpp>

#include "hdf5_handle.hpp"

namespace carom {

inline constexpr const char* kGroup = "/particles/discs";

/// Makes datasets and attributes while the file is laid out.
class H5mdLayout {
 public:
    H5mdLayout(hid_t file, const Hdf5Check& check) : file_(file), check_(check) {}

    void group(const std::string& name) const;
    void text(const std::string& object, const char* name, const std::vector<const char*>& values) const;
    void attribute(const std::string& object, const char* name, hid_t stored, hid_t given, const void* values,
                   hsize_t count) const;
    /// What does not change with time.
    void fixed(const std::string& name, hid_t stored, hid_t given, const std::vector<hsize_t>& size,
               const void* values) const;
    /// What grows by a frame at a time.
    void growing(const std::string& name, hid_t stored, std::vector<hsize_t> frame,
                 std::vector<hsize_t> chunk) const;
    void link(const std::string& from, const std::string& to) const;

 private:
    hid_t file_;
    const Hdf5Check& check_;
};

/// All of a file before its first frame.
void lay_out(const H5mdLayout& layout, std::span<const Ball> balls, const std::optional<Domain>& domain,
             Precision precision);

/// The part of it that frames go to, for so many balls and numbers of this type. Precondition: kGroup is
/// there.
void lay_out_frames(const H5mdLayout& layout, hsize_t count, hid_t number);

}  // namespace carom
