// HDF5's identifiers as objects that close themselves, and its failures as exceptions.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <utility>

#include <carom/io/atomic_file.hpp>

namespace carom {

class Hdf5Handle {
 public:
    using Close = herr_t (*)(hid_t);

    Hdf5Handle(hid_t id, Close closes) : id_(id), close_(closes) {}
    ~Hdf5Handle() {
        if (id_ >= 0) close_(id_);
    }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Hdf5Handle& operator=(Hdf5Handle&&) = delete;

    [[nodiscard]] hid_t id() const { return id_; }
    /// Closes it now, and gives what came of that: a file's last bytes may not find room.
    herr_t close() { return close_(std::exchange(id_, -1)); }

 private:
    hid_t id_;
    Close close_;
};

/// Throws FileError where HDF5 says that something has failed.
class Hdf5Check {
 public:
    explicit Hdf5Check(std::filesystem::path path) : path_(std::move(path)) {}

    [[noreturn]] void fail(const char* why) const { throw FileError(path_, why); }
    template <class Status>
    void operator()(Status status) const {
        if (status < 0) fail("cannot be written: HDF5 fails");
    }
    [[nodiscard]] Hdf5Handle own(hid_t id, Hdf5Handle::Close close) const {
        (*this)(id);
        return {id, close};
    }

 private:
    std::filesystem::path path_;
};

}  // namespace carom
