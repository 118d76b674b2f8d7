// SPDX-License-Identifier: Apache-2.0
// Layout: "OpenEXR File Layout", openexr.com: a magic number, a version with flags, then a list of
// attributes for each part, each list ended by an empty name.
#include "io/picture/exr_header.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>

namespace petzval {
namespace {

constexpr uint32_t kMultiPart = 0x1000;
constexpr size_t kLongestName = 255;

class HeaderCheck {
  public:
    explicit HeaderCheck(const std::filesystem::path& path) : in_(path, std::ios::binary) {
        std::error_code none;
        size_ = std::filesystem::file_size(path, none);
    }

    std::string complaint() {
        (void)word();  // the magic number
        const bool multi_part = (word() & kMultiPart) != 0;
        bool first = true;
        while (in_) {
            const std::string name = text();
            if (!in_) break;
            if (name.empty() && (first || !multi_part)) return "";
            first = name.empty();
            if (first) continue;
            (void)text();  // the type
            const uint32_t bytes = word();
            const auto at = static_cast<uint64_t>(in_.tellg());
            if (!in_ || bytes > size_ || at > size_ - bytes)
                return fmt::format(
                    "has an attribute of {} bytes, beyond its {}; it is damaged or "
                    "cut short",
                    bytes, size_);
            in_.seekg(bytes, std::ios::cur);
        }
        return "has no whole header; it is damaged or cut short";
    }

  private:
    uint32_t word() {
        std::array<unsigned char, 4> b{};
        in_.read(reinterpret_cast<char*>(b.data()), b.size());
        return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
    }
    /// Text up to its zero; one that is too long for a name fails the stream.
    std::string text() {
        std::string out;
        for (char c = 0; in_.get(c) && c != 0;) {
            out += c;
            if (out.size() > kLongestName) in_.setstate(std::ios::failbit);
        }
        return out;
    }

    std::ifstream in_;
    uint64_t size_ = 0;
};

}  // namespace

std::string exr_header_complaint(const std::filesystem::path& path) {
    return HeaderCheck(path).complaint();
}

}  // namespace petzval
