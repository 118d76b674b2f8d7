// SPDX-License-Identifier: Apache-2.0
#include "io/image/reduce.h"

#include <algorithm>
#include <stdexcept>

#include "core/math/math.h"
#include "core/spectrum/colour.h"

namespace petzval::io {
namespace {

/// What of the reduced pixel `to` a pixel makes up, and what of the one behind it.
struct Share {
    int to;
    double here, behind;
};

/// Shares of `from` pixels that become `to`: each covers no more than one of them, so it lies in
/// one or in two.
std::vector<Share> shares(int from, int to) {
    std::vector<Share> all;
    for (int64_t i = 0; i < from; ++i) {
        const int64_t begin = i * to, end = begin + to, first = begin / from;
        const int64_t here = std::min(end, (first + 1) * from) - begin;
        all.push_back({int(first), double(here) / from, double(to - here) / from});
    }
    return all;
}

/// Value that a display can show: not a number is black, as in 8-bit files.
float shown(float value) {
    return value > 0.f ? std::min(value, 1.f) : 0.f;
}

/// Linear values from which on an 8-bit level is the nearest one; of level 0 it is not needed.
std::array<double, 255> thresholds() {
    std::array<double, 255> from{};
    for (size_t i = 0; i < from.size(); ++i)
        from[i] = double(srgb_to_linear((float(i) + 0.5f) / 255.f));
    return from;
}

/// Rows of a display picture as linear light over a ground.
class LinearRows {
  public:
    LinearRows(const PictureRows& display, const Colour8& ground)
        : display_(display),
          values_(size_t(display.layout.width) * display.layout.channels.size()) {
        for (const char* name : {"R", "G", "B"}) {
            const int channel = channel_index(display.layout, name);
            if (channel < 0)
                throw std::invalid_argument("a display picture needs channels R, G and B");
            ground_[int(from_.size())] =
                double(srgb_to_linear(float(ground[from_.size()]) / 255.f));
            from_.push_back(channel);
        }
    }
    void read(int y, std::vector<V3d>& out) {
        display_.row(y, values_.data());
        const size_t channels = display_.layout.channels.size();
        const float* pixel = values_.data();
        for (V3d& light : out) {
            const double opaque = alpha_ < 0 ? 1. : double(shown(pixel[alpha_]));
            for (int c = 0; c < 3; ++c)
                light[c] = opaque * double(srgb_to_linear(shown(pixel[from_[size_t(c)]]))) +
                           (1. - opaque) * ground_[c];
            pixel += channels;
        }
    }

  private:
    const PictureRows& display_;
    std::vector<float> values_;
    std::vector<int> from_;
    int alpha_ = channel_index(display_.layout, "A");
    V3d ground_;
};

}  // namespace

Picture8 reduced(const PictureRows& display, int width, int height, const Colour8& ground) {
    const PictureLayout& layout = display.layout;
    if (width < 1 || height < 1 || width > layout.width || height > layout.height)
        throw std::invalid_argument("a picture is reduced to one that is smaller");
    LinearRows rows(display, ground);
    const std::array<double, 255> from = thresholds();
    const std::vector<Share> across = shares(layout.width, width),
                             down = shares(layout.height, height);
    Picture8 out{width, height, {}};
    out.rgb.reserve(size_t(width) * size_t(height) * 3);
    std::vector<V3d> source(size_t(layout.width)), sum(size_t(width), V3d(0.));
    std::vector<V3d> line(size_t(width) + 1);  // one more, for the share of nothing behind the end
    const auto emit = [&] {
        for (const V3d& light : sum)
            for (int c = 0; c < 3; ++c)
                out.rgb.push_back(static_cast<uint8_t>(
                    std::upper_bound(from.begin(), from.end(), light[c]) - from.begin()));
    };
    for (int y = 0; y < layout.height; ++y) {
        rows.read(y, source);
        std::fill(line.begin(), line.end(), V3d(0.));
        for (size_t x = 0; x < source.size(); ++x) {
            line[size_t(across[x].to)] += across[x].here * source[x];
            line[size_t(across[x].to) + 1] += across[x].behind * source[x];
        }
        const Share& share = down[size_t(y)];
        for (size_t x = 0; x < sum.size(); ++x) sum[x] += share.here * line[x];
        if (y + 1 < layout.height && down[size_t(y) + 1].to == share.to) continue;
        emit();
        for (size_t x = 0; x < sum.size(); ++x) sum[x] = share.behind * line[x];
    }
    return out;
}

}  // namespace petzval::io
