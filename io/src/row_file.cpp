#include <carom/io/row_file.hpp>

namespace carom {
namespace {
constexpr std::size_t kBufferSize = std::size_t{1} << 20;
}

RowFile::RowFile(const std::filesystem::path& path, std::string_view header) : buffer_(header) {
    whole_.emplace(path);
    buffer_.reserve(kBufferSize + 512);
}

RowFile::RowFile(const std::filesystem::path& path, std::string_view header, std::uint64_t kept) {
    if (kept > 0) {
        growing_ = std::make_unique<GrowingFile>(path, kept);
    } else {
        growing_ = std::make_unique<GrowingFile>(path);
        buffer_ = header;
    }
    buffer_.reserve(kBufferSize + 512);
}

void RowFile::end_row() {
    if (buffer_.size() >= kBufferSize) flush();
}

void RowFile::flush() {
    if (whole_)
        whole_->write(buffer_);
    else
        growing_->write(buffer_);
    buffer_.clear();
}

void RowFile::commit() {
    flush();
    if (whole_)
        whole_->commit();
    else
        growing_->sync();
}

std::uint64_t RowFile::sync() {
    flush();
    growing_->sync();
    return growing_->size();
}

}  // namespace carom
