// Checkpoints, writing: in pieces, so that the bytes never stand in memory beside the state.
#include <bit>
#include <string>

#include <carom/io/atomic_file.hpp>

#include "checkpoint_layout.hpp"
#include "crc64.hpp"
#include "little_endian.hpp"

namespace carom {
namespace {

using namespace checkpoint_layout;

/// A file with a checksum over what has been written to it.
class Sink {
 public:
    explicit Sink(const std::filesystem::path& path) : file_(path) { buffer_.reserve(kPiece + 1024); }

    void operator()(bool truth) { append_little_endian(buffer_, std::uint64_t{truth}); }
    void operator()(std::uint32_t n) { append_little_endian(buffer_, n); }
    void operator()(std::uint64_t n) { append_little_endian(buffer_, n); }
    void operator()(std::int32_t n) { append_little_endian(buffer_, static_cast<std::uint32_t>(n)); }
    void operator()(std::int64_t n) { append_little_endian(buffer_, static_cast<std::uint64_t>(n)); }
    void operator()(double x) { append_little_endian(buffer_, std::bit_cast<std::uint64_t>(x)); }
    void text(std::string_view t) { buffer_ += t; }
    void name(std::string_view t) {
        buffer_ += t;
        buffer_.append(kNameSize - t.size(), '\0');
    }
    void flush_if_full() {
        if (buffer_.size() >= kPiece) flush();
    }
    void commit() {
        flush();
        (*this)(checksum_.value());
        flush();
        file_.commit();
    }

 private:
    static constexpr std::size_t kPiece = std::size_t{1} << 20;

    void flush() {
        checksum_.add(buffer_);
        file_.write(buffer_);
        buffer_.clear();
    }

    AtomicFile file_;
    Crc64 checksum_;
    std::string buffer_;
};

/// What the sections will take.
struct Sizes {
    std::uint32_t sections = 0;
    std::uint64_t bytes = 0;

    void add(std::uint64_t size) {
        ++sections;
        bytes += kSectionHeaderSize + size;
    }
    template <class... T>
    void items(std::string_view, const T&...) {
        add((size_of<T>() + ...));
    }
    template <class T>
    void list(std::string_view, const std::vector<T>& all) {
        if (!all.empty()) add(all.size() * size_of<T>());
    }
    template <class T>
    void optional(std::string_view, const std::optional<T>& item) {
        if (item) add(size_of<T>());
    }
    template <class T>
    void optional(std::string_view, const std::optional<std::vector<T>>& all) {
        if (all) add(all->size() * size_of<T>());
    }
};

struct SectionWriter {
    Sink& sink;

    void start(std::string_view name, std::uint64_t size) {
        sink.name(name);
        sink(size);
    }
    template <class... T>
    void items(std::string_view name, const T&... item) {
        start(name, (size_of<T>() + ...));
        (each(sink, item), ...);
    }
    template <class T>
    void write(std::string_view name, const std::vector<T>& all) {
        start(name, all.size() * size_of<T>());
        for (const T& item : all) {
            each(sink, item);
            sink.flush_if_full();
        }
    }
    template <class T>
    void list(std::string_view name, const std::vector<T>& all) {
        if (!all.empty()) write(name, all);
    }
    template <class T>
    void optional(std::string_view name, const std::optional<T>& item) {
        if (item) items(name, *item);
    }
    template <class T>
    void optional(std::string_view name, const std::optional<std::vector<T>>& all) {
        if (all) write(name, *all);
    }
};

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
    const Snapshot& s = checkpoint.snapshot;
    if (s.edited) throw FileError(path, "cannot be written: it would not hold the bodies that were edited");
    if (s.method.size() > kNameSize)
        throw FileError(path, "cannot be written: the method's name is too long");
    Sink sink(path);
    Sizes sizes;
    for_each_section(sizes, checkpoint);
    sink.text(kMagic);
    sink(kVersion);
    sink(sizes.sections);
    sink(kHeaderSize + sizes.bytes + kChecksumSize);
    sink(s.scene_hash);
    sink(std::uint64_t{s.anchors.size()});
    sink.name(s.method);
    SectionWriter writer{sink};
    for_each_section(writer, checkpoint);
    sink.commit();
}

}  // namespace carom
