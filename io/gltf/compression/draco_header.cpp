// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/draco_header.h"

#include <algorithm>
#include <string_view>

namespace petzval::io {
namespace {

/// Reads bytes from the front; one that is not there makes it fail for good.
class Bytes {
  public:
    Bytes(std::span<const uint8_t> bytes, size_t at) : bytes_(bytes), at_(at) {}

    [[nodiscard]] size_t at() const { return at_; }
    [[nodiscard]] bool failed() const { return failed_; }

    uint8_t byte() {
        failed_ |= at_ >= bytes_.size();
        return failed_ ? 0 : bytes_[at_++];
    }

    /// A number in bytes of 7 bits, low ones first; fails beyond 32 bits, where the library would
    /// drop the high ones.
    uint32_t varint() {
        uint64_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            const uint8_t next = byte();
            value |= uint64_t(next & 0x7f) << shift;
            if (next < 0x80) {
                failed_ |= value > UINT32_MAX;
                return static_cast<uint32_t>(value);
            }
        }
        failed_ = true;
        return 0;
    }

    void skip(uint64_t count) {
        failed_ |= count > bytes_.size() - at_;
        if (!failed_) at_ += count;
    }

  private:
    std::span<const uint8_t> bytes_;
    size_t at_;
    bool failed_ = false;
};

/// Skips metadata, which glTF has no use for. The library's reader of them takes memory by the
/// product of two numbers in the file. Metadata hold metadata, one after the other.
void skip_metadata(Bytes& bytes) {
    const auto skip_one = [&](bool named, auto& left) {
        if (named) bytes.skip(bytes.byte());
        for (uint32_t entries = bytes.varint(); entries > 0 && !bytes.failed(); --entries) {
            bytes.skip(bytes.byte());
            bytes.skip(bytes.varint());
        }
        left += bytes.varint();
    };
    const auto skip_tree = [&] {
        uint64_t left = 0;
        skip_one(false, left);
        for (; left > 0 && !bytes.failed(); --left) skip_one(true, left);
    };
    for (uint32_t attributes = bytes.varint(); attributes > 0 && !bytes.failed(); --attributes) {
        (void)bytes.varint();
        skip_tree();
    }
    skip_tree();
}

/// Bytes for a face: its corners and their neighbours, vertices, symbols and the stack of them;
/// then for each attribute with seams its corners and vertices again.
constexpr uint64_t kFaceBytes = 128, kSeamBytes = 64;

void read_edgebreaker(Bytes& bytes, DracoHeader& header) {
    constexpr uint8_t standard = 0, valence = 2;
    const uint8_t traversal = bytes.byte();
    const uint32_t vertices = bytes.varint();
    header.faces = bytes.varint();
    const uint64_t seams = bytes.byte();
    if (bytes.failed()) return;
    header.working_bytes = header.faces * (kFaceBytes + seams * kSeamBytes);
    if (traversal != standard && traversal != valence)
        header.fault = "it uses a way of Draco to store triangles that is no longer in use";
    else if (vertices > 3 * header.faces)
        header.fault = "it has more vertices than its triangles have corners; the file is damaged";
}

void read_sequential(Bytes& bytes, DracoHeader& header) {
    header.faces = bytes.varint();
    (void)bytes.varint();
    header.working_bytes = header.faces * kFaceBytes;
}

}  // namespace

DracoHeader read_draco_header(std::span<const uint8_t> stream) {
    constexpr std::string_view magic = "DRACO";
    constexpr uint8_t triangular_mesh = 1, metadata_flag = 0x80;
    DracoHeader header;
    const auto fault = [&](const char* text) {
        header.fault = text;
        return header;
    };
    if (stream.size() < kDracoHeaderBytes ||
        !std::equal(magic.begin(), magic.end(), stream.begin()))
        return fault("its data are no Draco stream; the file is damaged");
    if (stream[5] != 2 || stream[6] != 2)
        return fault("its stream is not of version 2.2, the one that glTF allows; encode it anew");
    if (stream[7] != triangular_mesh) return fault("its stream is a cloud of points, not a mesh");
    if (stream[8] > 1) return fault("its stream is encoded in an unknown way");
    header.connectivity = static_cast<DracoConnectivity>(stream[8]);

    Bytes bytes(stream, kDracoHeaderBytes);
    if (stream[10] & metadata_flag) skip_metadata(bytes);
    header.body = bytes.at();
    if (header.connectivity == DracoConnectivity::Edgebreaker)
        read_edgebreaker(bytes, header);
    else
        read_sequential(bytes, header);
    if (bytes.failed()) return fault("its stream is cut short; the file is damaged");
    if (header.fault.empty() && header.working_bytes > draco_memory_limit(stream.size()))
        return fault("its stream is far too short for its triangles; the file is damaged");
    return header;
}

}  // namespace petzval::io
