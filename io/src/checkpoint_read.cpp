// Checkpoints, reading: nothing is believed before the checksum fits, and nothing is allocated that the file
// does not hold.
#include <algorithm>
#include <bit>
#include <string>

#include <fmt/format.h>

#include <carom/io/atomic_file.hpp>
#include <carom/io/read_file.hpp>

#include "checkpoint_layout.hpp"
#include "crc64.hpp"
#include "json_value.hpp"
#include "little_endian.hpp"

namespace carom {
namespace {

using namespace checkpoint_layout;

/// Numbers one after the other. Precondition of each: the bytes are there.
class Source {
 public:
    explicit Source(std::string_view bytes) : rest_(bytes) {}

    [[nodiscard]] std::size_t size() const { return rest_.size(); }
    std::string_view text(std::size_t size) {
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    std::string name() {
        const std::string_view padded = text(kNameSize);
        return std::string(padded.substr(0, padded.find('\0')));
    }
    template <class Unsigned>
    Unsigned take() {
        return first_little_endian<Unsigned>(text(sizeof(Unsigned)));
    }

    void operator()(bool& truth) { truth = take<std::uint64_t>() != 0; }
    void operator()(std::uint32_t& n) { n = take<std::uint32_t>(); }
    void operator()(std::uint64_t& n) { n = take<std::uint64_t>(); }
    void operator()(std::int32_t& n) { n = static_cast<std::int32_t>(take<std::uint32_t>()); }
    void operator()(std::int64_t& n) { n = static_cast<std::int64_t>(take<std::uint64_t>()); }
    void operator()(double& x) { x = std::bit_cast<double>(take<std::uint64_t>()); }

 private:
    std::string_view rest_;
};

struct Section {
    std::string name;
    std::string_view content;
};

/// Fills a checkpoint from sections that may stand in any order, and sees to it that each is used once.
struct SectionReader {
    std::vector<Section> sections;
    std::uint64_t balls = 0;
    const std::string& file;

    [[noreturn]] void fail(std::string_view name) const {
        throw FileError(file, fmt::format("is no sound checkpoint: section '{}'", quotable(name)));
    }
    std::optional<std::string_view> find(std::string_view name) {
        const auto found = std::ranges::find(sections, name, &Section::name);
        if (found == sections.end()) return std::nullopt;
        const std::string_view content = found->content;
        sections.erase(found);
        return content;
    }
    template <class... T>
    void items(std::string_view name, T&... item) {
        const std::optional<std::string_view> content = find(name);
        if (!content || content->size() != (size_of<T>() + ...)) fail(name);
        Source source(*content);
        (each(source, item), ...);
    }
    template <class T>
    static void read(std::string_view content, std::vector<T>& all) {
        all.resize(content.size() / size_of<T>());
        Source source(content);
        for (T& item : all) each(source, item);
    }
    template <class T>
    void list(std::string_view name, std::vector<T>& all) {
        const std::optional<std::string_view> content = find(name);
        if (!content) return;
        if (content->size() % size_of<T>() != 0 || content->size() / size_of<T>() != balls) fail(name);
        read(*content, all);
    }
    template <class T>
    void optional(std::string_view name, std::optional<T>& item) {
        const std::optional<std::string_view> content = find(name);
        if (!content) return;
        if (content->size() != size_of<T>()) fail(name);
        Source source(*content);
        each(source, item.emplace());
    }
    template <class T>
    void optional(std::string_view name, std::optional<std::vector<T>>& all) {
        const std::optional<std::string_view> content = find(name);
        if (!content) return;
        if (content->size() % size_of<T>() != 0) fail(name);
        read(*content, all.emplace());
    }
};

/// What is wrong with the file as a whole; empty where nothing is.
std::string fault_of(std::string_view bytes) {
    if (!bytes.starts_with(kMagic.substr(0, std::min(bytes.size(), kMagic.size()))))
        return "is no checkpoint";
    if (bytes.size() < kHeaderSize + kChecksumSize) return "is no whole checkpoint: it is cut short";
    Source header(bytes.substr(kMagic.size()));
    const auto version = header.take<std::uint32_t>();
    if (version != kVersion)
        return fmt::format("is a checkpoint of version {}; this program knows version {}", version, kVersion);
    (void)header.take<std::uint32_t>();
    const auto size = header.take<std::uint64_t>();
    if (bytes.size() != size)
        return fmt::format("is no whole checkpoint: it has {} bytes, its header says {}", bytes.size(), size);
    Crc64 checksum;
    checksum.add(bytes.substr(0, bytes.size() - kChecksumSize));
    if (checksum.value() != first_little_endian<std::uint64_t>(bytes.substr(bytes.size() - kChecksumSize)))
        return "is damaged: its checksum does not fit";
    return "";
}

}  // namespace

Checkpoint parse_checkpoint(std::string_view bytes, const std::string& name) {
    if (const std::string fault = fault_of(bytes); !fault.empty()) throw FileError(name, fault);
    Source source(bytes.substr(kMagic.size() + sizeof(kVersion),
                               bytes.size() - kMagic.size() - sizeof(kVersion) - kChecksumSize));
    Checkpoint checkpoint;
    SectionReader reader{{}, 0, name};
    const auto count = source.take<std::uint32_t>();
    (void)source.take<std::uint64_t>();
    checkpoint.snapshot.scene_hash = source.take<std::uint64_t>();
    reader.balls = source.take<std::uint64_t>();
    checkpoint.snapshot.method = source.name();
    if (quotable(checkpoint.snapshot.method) != checkpoint.snapshot.method)
        throw FileError(name, "is no sound checkpoint: its method has no name");
    for (std::uint32_t k = 0; k < count; ++k) {
        if (source.size() < kSectionHeaderSize) reader.fail("number " + std::to_string(k));
        const std::string section = source.name();
        const auto size = source.take<std::uint64_t>();
        if (size > source.size()) reader.fail(section);
        reader.sections.push_back({section, source.text(size)});
    }
    if (source.size() != 0) reader.fail("after the last");
    for_each_section(reader, checkpoint);
    if (!reader.sections.empty()) reader.fail(reader.sections.front().name);
    if (checkpoint.snapshot.anchors.size() != reader.balls) reader.fail("anchors");
    return checkpoint;
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
    return parse_checkpoint(read_file(path), path.string());
}

}  // namespace carom
