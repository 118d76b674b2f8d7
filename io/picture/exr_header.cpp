// SPDX-License-Identifier: Apache-2.0
// Layout: "OpenEXR File Layout", openexr.com: a magic number, a version with flags, then a list of
// attributes for each part, each list ended by an empty name.
#include "io/picture/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "io/file/read_file.h"

namespace petzval::io {
namespace {

constexpr uint32_t kMultiPart = 0x1000;
constexpr size_t kLongestName = 255;

class HeaderCheck {
  public:
    explicit HeaderCheck(const std::filesystem::path& path) : in_(path) {}

    std::string complaint() {
        (void)word();  // the magic number
        const bool multi_part = (word() & kMultiPart) != 0;
        bool first = true;
        while (good_) {
            const std::string name = text();
            if (!good_) break;
            if (name.empty() && (first || !multi_part)) return "";
            first = name.empty();
            if (first) continue;
            (void)text();  // the type
            const uint32_t bytes = word();
            if (!good_ || bytes > in_.size() || at_ > in_.size() - bytes)
                return fmt::format(
                    "has an attribute of {} bytes, beyond its {}; it is damaged or cut short",
                    bytes, in_.size());
            at_ += bytes;
        }
        return "has no whole header; it is damaged or cut short";
    }

  private:
    uint32_t word() {
        std::array<uint8_t, 4> b{};
        good_ = good_ && in_.read(b, at_) == b.size();
        at_ += b.size();
        return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
    }
    /// Text up to its zero; one that is too long for a name is not good.
    std::string text() {
        std::array<uint8_t, kLongestName + 1> b{};
        const auto end = b.begin() + std::ptrdiff_t(in_.read(b, at_));
        const auto zero = std::find(b.begin(), end, 0);
        good_ = good_ && zero != end;
        at_ += uint64_t(zero - b.begin()) + 1;
        return {b.begin(), zero};
    }

    const InputFile in_;
    uint64_t at_ = 0;
    bool good_ = true;
};

}  // namespace

std::string exr_header_complaint(const std::filesystem::path& path) {
    return HeaderCheck(path).complaint();
}

}  // namespace petzval::io
