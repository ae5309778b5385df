// H5MD: the file's layout when it is made, a frame, and what is kept of a file.
//
// A frame is appended in HDF5's mode of one writer and many readers, which orders what reaches the file so
// that a kill at any moment leaves a file that can be read, and the file is closed after each frame, so that
// ordinary readers can open it in between. The times are appended last: a frame without one does not count.
#include "h5md.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "h5md_layout.hpp"
#include "hdf5_handle.hpp"
#include "posix_write.hpp"

namespace carom {
namespace {

// Of marks: no text is so long, so that neither kind of trajectory is gone on with as the other.
constexpr std::uint64_t kMarkOfFrames = std::uint64_t{1} << 63;
// In the order in which a frame is appended.
constexpr std::array<const char*, 4> kGrowing = {"position/value", "velocity/value", "position/step",
                                                 "position/time"};
constexpr const char* kForeign = "cannot be gone on with: is no trajectory of Carom's";

class H5mdTrajectory final : public Trajectory {
 public:
    H5mdTrajectory(const std::filesystem::path& path, const KeptFrames& kept)
        : path_(path), check_(path), step_(kept.frames) {
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures are told in one line, by FileError
        if (kept.mark == 0) {
            const AtomicFile can_be_written(path);
            if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
                check_.fail("cannot be written as HDF5: is no regular file");
            return;
        }
        if (kept.mark < kMarkOfFrames)
            check_.fail("cannot be gone on with: the checkpoint's trajectory is text");
        keep(kept.mark - kMarkOfFrames);
    }

    void write(double time, std::span<const Ball> balls, const std::optional<Domain>& domain,
               Precision precision) override {
        if (!exists_) create(balls, domain, precision);
        if (balls.size() != count_) check_.fail("cannot be written: H5MD needs as many balls in every frame");
        std::vector<Vec2> positions;
        std::vector<Vec2> velocities;
        for (const Ball& ball : balls) {
            positions.push_back(ball.position);
            velocities.push_back(ball.velocity);
        }
        Hdf5Handle file = open(H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE);
        append(file, kGrowing[0], H5T_NATIVE_DOUBLE, positions.data());
        append(file, kGrowing[1], H5T_NATIVE_DOUBLE, velocities.data());
        append(file, kGrowing[2], H5T_NATIVE_UINT64, &step_);
        append(file, kGrowing[3], H5T_NATIVE_DOUBLE, &time);
        check_(file.close());
        ++frames_;
        ++step_;
    }

    std::uint64_t sync() override {
        if (!exists_) return 0;
        const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
        const bool good = descriptor >= 0 && ::fsync(descriptor) == 0;
        const int error = errno;
        if (descriptor >= 0) ::close(descriptor);
        if (!good) throw FileError(path_, "cannot be written: " + reason(error));
        return kMarkOfFrames + frames_;
    }

 private:
    [[nodiscard]] Hdf5Handle access() const {
        Hdf5Handle how = check_.own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
        check_(H5Pset_libver_bounds(how.id(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST));
        check_(H5Pset_file_locking(how.id(), false, true));  // who reads must not stop the run
        return how;
    }
    [[nodiscard]] Hdf5Handle open(unsigned flags) const {
        return check_.own(H5Fopen(path_.c_str(), flags, access().id()), H5Fclose);
    }

    /// The whole layout appears under the name at once.
    void create(std::span<const Ball> balls, const std::optional<Domain>& domain, Precision precision) {
        put_in_place([&](const Hdf5Handle& file) {
            lay_out(H5mdLayout(file.id(), check_), balls, domain, precision);
        });
        count_ = balls.size();
    }

    template <class Fill>
    void put_in_place(Fill&& fill) {
        std::filesystem::path temporary = path_;
        temporary += ".new.part";
        {
            Hdf5Handle file =
                check_.own(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access().id()), H5Fclose);
            try {
                fill(file);
                check_(file.close());
            } catch (...) {
                std::error_code ignored;
                std::filesystem::remove(temporary, ignored);
                throw;
            }
        }
        if (std::rename(temporary.c_str(), path_.c_str()) != 0)
            throw FileError(path_, "cannot be written: " + reason(errno));
        exists_ = true;
    }

    void append(const Hdf5Handle& file, const char* name, hid_t given, const void* values) const {
        const std::string path = std::string(kGroup) + "/" + name;
        const Hdf5Handle set = check_.own(H5Dopen2(file.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
        std::array<hsize_t, 3> size = {frames_ + 1, count_, 2};
        check_(H5Dset_extent(set.id(), size.data()));
        if (count_ == 0 && size_of(set)[2] == 2) return;
        const Hdf5Handle space = frame_of(set, count_);
        const Hdf5Handle memory = memory_of(space, count_);
        check_(H5Dwrite(set.id(), given, memory.id(), space.id(), H5P_DEFAULT, values));
        check_(H5Dflush(set.id()));
    }

    /// Goes on after so many frames of what a run has left, which may have been killed: they are copied, so
    /// that another kill in the middle of it costs nothing.
    void keep(std::uint64_t frames) {
        const hid_t old = H5Fopen(path_.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access().id());
        if (old < 0) check_.fail("cannot be gone on with: is not there, or no HDF5 file");
        const Hdf5Handle from(old, H5Fclose);
        const hid_t value =
            H5Dopen2(from.id(), (std::string(kGroup) + "/position/value").c_str(), H5P_DEFAULT);
        if (value < 0) check_.fail(kForeign);
        const Hdf5Handle positions(value, H5Dclose);
        const Hdf5Handle number = check_.own(H5Dget_type(positions.id()), H5Tclose);
        count_ = size_of(positions)[1];
        put_in_place([&](const Hdf5Handle& file) {
            const H5mdLayout layout(file.id(), check_);
            layout.group("/particles");
            layout.group(kGroup);
            for (const char* const name :
                 {"/h5md", "/particles/discs/box", "/particles/discs/id", "/particles/discs/radius",
                  "/particles/discs/mass", "/particles/discs/restitution", "/particles/discs/static",
                  "/particles/discs/acceleration"})
                if (H5Ocopy(from.id(), name, file.id(), name, H5P_DEFAULT, H5P_DEFAULT) < 0)
                    check_.fail(kForeign);
            lay_out_frames(layout, count_, number.id());
            for (frames_ = 0; frames_ < frames; ++frames_) copy_frame(from, file);
        });
    }

    /// Rows, and what a row has; 1 where it has no more.
    [[nodiscard]] std::array<hsize_t, 3> size_of(const Hdf5Handle& set) const {
        const Hdf5Handle space = check_.own(H5Dget_space(set.id()), H5Sclose);
        std::array<hsize_t, 3> size = {1, 1, 1};
        if (H5Sget_simple_extent_ndims(space.id()) > 3) check_.fail(kForeign);
        H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
        return size;
    }

    void copy_frame(const Hdf5Handle& from, const Hdf5Handle& file) const {
        for (const char* const name : kGrowing) {
            const std::string path = std::string(kGroup) + "/" + name;
            const hid_t id = H5Dopen2(from.id(), path.c_str(), H5P_DEFAULT);
            if (id < 0) check_.fail(kForeign);
            const Hdf5Handle set(id, H5Dclose);
            const std::array<hsize_t, 3> size = size_of(set);
            if (size[0] <= frames_)
                check_.fail("cannot be gone on with: has fewer frames than the checkpoint covers");
            const bool is_step = std::string_view(name).ends_with("step");
            const hid_t given = is_step ? H5T_NATIVE_UINT64 : H5T_NATIVE_DOUBLE;
            std::vector<double> row(size[1] * size[2]);  // a step takes as many bytes
            const Hdf5Handle space = frame_of(set, size[1]);
            const Hdf5Handle memory = memory_of(space, size[1]);
            check_(H5Dread(set.id(), given, memory.id(), space.id(), H5P_DEFAULT, row.data()));
            append(file, name, given, row.data());
        }
    }

    /// Frame number frames_ of a dataset.
    [[nodiscard]] Hdf5Handle frame_of(const Hdf5Handle& set, hsize_t count) const {
        Hdf5Handle space = check_.own(H5Dget_space(set.id()), H5Sclose);
        const std::array<hsize_t, 3> start = {frames_, 0, 0};
        const std::array<hsize_t, 3> frame = {1, count, 2};
        check_(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, frame.data(), nullptr));
        return space;
    }
    [[nodiscard]] Hdf5Handle memory_of(const Hdf5Handle& space, hsize_t count) const {
        const std::array<hsize_t, 3> frame = {1, count, 2};
        return check_.own(H5Screate_simple(H5Sget_simple_extent_ndims(space.id()), frame.data(), nullptr),
                          H5Sclose);
    }

    std::filesystem::path path_;
    Hdf5Check check_;
    std::uint64_t step_;
    std::uint64_t frames_ = 0;
    std::uint64_t count_ = 0;  // of balls
    bool exists_ = false;
};

}  // namespace

bool has_h5md() {
    return true;
}

std::unique_ptr<Trajectory> open_h5md(const std::filesystem::path& path, const KeptFrames& kept) {
    return std::make_unique<H5mdTrajectory>(path, kept);
}

}  // namespace carom
