// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/glb.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/base/error.h"

namespace petzval::io {
namespace {

constexpr size_t header_size = 12;
constexpr size_t chunk_header_size = 8;
constexpr uint32_t magic = 0x46546C67;       // "glTF"
constexpr uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr uint32_t bin_chunk = 0x004E4942;   // "BIN\0"

uint32_t word_at(std::span<const uint8_t> bytes, size_t at) {
    return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 |
           uint32_t(bytes[at + 3]) << 24;
}

class Splitter {
  public:
    Splitter(std::span<const uint8_t> bytes, const std::string& file, WarningLog& warnings)
        : bytes_(bytes), file_(file), warnings_(warnings) {}

    GlbChunks split() {
        read_header();
        for (at_ = header_size; at_ < bytes_.size();) read_chunk();
        if (!has_json_) fail(header_size, "there is no JSON chunk");
        return chunks_;
    }

  private:
    [[noreturn]] void fail(size_t byte, const std::string& message) const {
        throw InputError(file_, fmt::format("byte {}", byte),
                         message + "; the file is damaged or cut short");
    }

    void read_header() {
        if (bytes_.size() < header_size)
            fail(0, fmt::format("the header needs {} bytes, the file has {}", header_size,
                                bytes_.size()));
        const uint32_t version = word_at(bytes_, 4), length = word_at(bytes_, 8);
        if (version != 2)
            throw InputError(file_, "byte 4", "is a container of version {}; only 2 can be read",
                             version);
        if (length > bytes_.size() || length < header_size + chunk_header_size)
            fail(8, fmt::format("the header promises {} bytes, the file has {}", length,
                                bytes_.size()));
        if (length < bytes_.size())
            warnings_.push_back(fmt::format("{} bytes after the end of the container are skipped",
                                            bytes_.size() - length));
        bytes_ = bytes_.first(length);
    }

    void read_chunk() {
        const size_t start = at_, left = bytes_.size() - at_;
        if (left < chunk_header_size)
            fail(start, fmt::format("a chunk header needs {} bytes, {} are left", chunk_header_size,
                                    left));
        const uint32_t length = word_at(bytes_, start), type = word_at(bytes_, start + 4);
        if (length > left - chunk_header_size)
            fail(start, fmt::format("a chunk promises {} bytes, {} are left", length,
                                    left - chunk_header_size));
        take(type, bytes_.subspan(start + chunk_header_size, length));
        at_ = start + chunk_header_size + length;
        if (length % 4 != 0) skip_padding(start, length);
    }

    /// A chunk's length should be a multiple of 4. Exporters that forget it write the next chunk
    /// either at once or at the next such place.
    void skip_padding(size_t start, uint32_t length) {
        warnings_.push_back(fmt::format(
            "byte {}: a chunk's length is {} and must be a multiple of 4; it is read all the same",
            start, length));
        const auto is_chunk = [&](size_t at) {
            return bytes_.size() - at >= chunk_header_size &&
                   (word_at(bytes_, at + 4) == bin_chunk || word_at(bytes_, at + 4) == json_chunk);
        };
        if (!is_chunk(at_)) at_ = std::min((at_ + 3) / 4 * 4, bytes_.size());
    }

    void take(uint32_t type, std::span<const uint8_t> data) {
        if (!has_json_ && type != json_chunk) fail(at_, "the first chunk must be the JSON");
        if (type == json_chunk) {
            if (has_json_) fail(at_, "there is a second JSON chunk");
            if (data.empty()) fail(at_, "the JSON chunk is empty");
            while (!data.empty() && data.back() == 0)
                data = data.first(data.size() - 1);  // padding
            chunks_.json = {reinterpret_cast<const char*>(data.data()), data.size()};
            has_json_ = true;
        } else if (type == bin_chunk) {
            if (chunks_.bin)
                warnings_.push_back(fmt::format("byte {}: a second BIN chunk is skipped", at_));
            else
                chunks_.bin = data;
        } else {
            warnings_.push_back(
                fmt::format("byte {}: a chunk of unknown type {:#010x} is skipped", at_, type));
        }
    }

    std::span<const uint8_t> bytes_;
    const std::string& file_;
    WarningLog& warnings_;
    GlbChunks chunks_;
    size_t at_ = 0;
    bool has_json_ = false;
};

}  // namespace

bool is_glb(std::span<const uint8_t> bytes) {
    return bytes.size() >= 4 && word_at(bytes, 0) == magic;
}

GlbChunks split_glb(std::span<const uint8_t> bytes, const std::string& file, WarningLog& warnings) {
    return Splitter(bytes, file, warnings).split();
}

}  // namespace petzval::io
