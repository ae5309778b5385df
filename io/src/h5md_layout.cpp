#include "h5md_layout.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace carom {
namespace {

constexpr hsize_t kChunk = 1 << 14;    // balls
constexpr unsigned kDeflateLevel = 1;  // random digits gain nothing from more

void lay_out_box(const H5mdLayout& layout, const std::optional<Domain>& domain) {
    const std::string box = std::string(kGroup) + "/box";
    layout.group(box);
    const int dimension = 2;
    layout.attribute(box, "dimension", H5T_STD_I32LE, H5T_NATIVE_INT, &dimension, 1);
    const auto kind = [&domain](int axis) {
        return domain && domain->boundary[axis] == Boundary::kPeriodic ? "periodic" : "none";
    };
    layout.text(box, "boundary", {kind(0), kind(1)});
    if (!domain) return;
    const Vec2 edges = domain->box.max - domain->box.min;
    layout.fixed(box + "/edges", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {2}, edges.data());
    layout.fixed(box + "/offset", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {2}, domain->box.min.data());
}

void lay_out_balls(const H5mdLayout& layout, std::span<const Ball> balls) {
    const auto number = [&](const char* name, auto part) {
        std::vector<double> values;
        for (const Ball& ball : balls) values.push_back(part(ball));
        layout.fixed(std::string(kGroup) + "/" + name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {values.size()},
                     values.data());
    };
    number("radius", [](const Ball& ball) { return ball.radius; });
    number("mass", [](const Ball& ball) { return ball.mass; });
    number("restitution", [](const Ball& ball) { return ball.restitution; });
    std::vector<std::uint64_t> ids;
    std::vector<std::uint8_t> is_static;
    std::vector<Vec2> acceleration;
    for (const Ball& ball : balls) {
        ids.push_back(ids.size());
        is_static.push_back(ball.is_static ? 1 : 0);
        acceleration.push_back(ball.acceleration);
    }
    const std::string group = std::string(kGroup) + "/";
    layout.fixed(group + "id", H5T_STD_U64LE, H5T_NATIVE_UINT64, {ids.size()}, ids.data());
    layout.fixed(group + "static", H5T_STD_U8LE, H5T_NATIVE_UINT8, {ids.size()}, is_static.data());
    layout.fixed(group + "acceleration", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {ids.size(), 2},
                 acceleration.data());
}

}  // namespace

void H5mdLayout::group(const std::string& name) const {
    (void)check_.own(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
}

void H5mdLayout::text(const std::string& object, const char* name,
                      const std::vector<const char*>& values) const {
    const Hdf5Handle type = check_.own(H5Tcopy(H5T_C_S1), H5Tclose);
    check_(H5Tset_size(type.id(), H5T_VARIABLE));
    attribute(object, name, type.id(), type.id(), static_cast<const void*>(values.data()), values.size());
}

void H5mdLayout::attribute(const std::string& object, const char* name, hid_t stored, hid_t given,
                           const void* values, hsize_t count) const {
    const Hdf5Handle space = count == 1 ? check_.own(H5Screate(H5S_SCALAR), H5Sclose)
                                        : check_.own(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Hdf5Handle a = check_.own(H5Acreate_by_name(file_, object.c_str(), name, stored, space.id(),
                                                      H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                    H5Aclose);
    check_(H5Awrite(a.id(), given, values));
}

void H5mdLayout::fixed(const std::string& name, hid_t stored, hid_t given, const std::vector<hsize_t>& size,
                       const void* values) const {
    const Hdf5Handle space =
        check_.own(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Hdf5Handle d = check_.own(
        H5Dcreate2(file_, name.c_str(), stored, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    check_(H5Dwrite(d.id(), given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
}

void H5mdLayout::growing(const std::string& name, hid_t stored, std::vector<hsize_t> frame,
                         std::vector<hsize_t> chunk) const {
    const auto rank = static_cast<int>(frame.size() + 1);
    std::vector<hsize_t> most = frame;
    frame.insert(frame.begin(), 0);
    most.insert(most.begin(), H5S_UNLIMITED);
    chunk.insert(chunk.begin(), rank == 1 ? 256 : 1);
    const Hdf5Handle space = check_.own(H5Screate_simple(rank, frame.data(), most.data()), H5Sclose);
    const Hdf5Handle how = check_.own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check_(H5Pset_chunk(how.id(), rank, chunk.data()));
    if (rank > 1) {
        check_(H5Pset_shuffle(how.id()));
        check_(H5Pset_deflate(how.id(), kDeflateLevel));
    }
    (void)check_.own(H5Dcreate2(file_, name.c_str(), stored, space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT),
                     H5Dclose);
}

void H5mdLayout::link(const std::string& from, const std::string& to) const {
    check_(H5Lcreate_hard(file_, from.c_str(), file_, to.c_str(), H5P_DEFAULT, H5P_DEFAULT));
}

void lay_out_frames(const H5mdLayout& layout, hsize_t count, hid_t number) {
    const std::string group = std::string(kGroup) + "/";
    for (const std::string name : {"position", "velocity"}) {
        layout.group(group + name);
        layout.growing(group + name + "/value", number, {count, 2},
                       {std::clamp<hsize_t>(count, 1, kChunk), 2});
    }
    layout.growing(group + "position/step", H5T_STD_I64LE, {}, {});
    layout.growing(group + "position/time", H5T_IEEE_F64LE, {}, {});
    layout.link(group + "position/step", group + "velocity/step");
    layout.link(group + "position/time", group + "velocity/time");
}

void lay_out(const H5mdLayout& layout, std::span<const Ball> balls, const std::optional<Domain>& domain,
             Precision precision) {
    layout.group("/h5md");
    const std::array<int, 2> version = {1, 1};
    layout.attribute("/h5md", "version", H5T_STD_I32LE, H5T_NATIVE_INT, version.data(), 2);
    layout.group("/h5md/author");
    layout.text("/h5md/author", "name", {"unknown"});
    layout.group("/h5md/creator");
    layout.text("/h5md/creator", "name", {"carom"});
    layout.text("/h5md/creator", "version", {CAROM_VERSION});
    layout.group("/particles");
    layout.group(kGroup);
    lay_out_box(layout, domain);
    lay_out_balls(layout, balls);
    lay_out_frames(layout, balls.size(), precision == Precision::kFloat ? H5T_IEEE_F32LE : H5T_IEEE_F64LE);
}

}  // namespace carom
