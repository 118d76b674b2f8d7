// SPDX-License-Identifier: Apache-2.0
// Noise and error of renders, for programs that set strategies against each other. Colour is split
// into luminance Y and R - Y, G - Y, B - Y: what is left of a colour when its luminance is taken
// away, here called chroma.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/film/film.h"
#include "core/spectrum/colour.h"
#include "integrator/render/executor.h"
#include "integrator/render/render.h"
#include "io/base/clock.h"

namespace petzval {

struct PixelMoments {
    std::array<double, 4> mean{}, variance{};  ///< over renders; Y, R - Y, G - Y, B - Y
};

/// Moments of every pixel over renders of different seeds, two at least, in scan order.
[[nodiscard]] inline std::vector<PixelMoments> moments_of(const std::vector<Film>& films) {
    const Rect crop = films.front().crop();
    const auto n = static_cast<double>(films.size());
    std::vector<PixelMoments> pixels;
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            PixelMoments p;
            std::array<double, 4> squares{};
            for (const Film& film : films) {
                const V4f c = film.colour(x, y);
                const double l = luminance(Rgb(c.x, c.y, c.z));
                const std::array<double, 4> v{l, c.x - l, c.y - l, c.z - l};
                for (size_t i = 0; i < 4; ++i) {
                    p.mean[i] += v[i] / n;
                    squares[i] += v[i] * v[i] / n;
                }
            }
            for (size_t i = 0; i < 4; ++i)
                p.variance[i] = (squares[i] - p.mean[i] * p.mean[i]) * n / (n - 1);
            pixels.push_back(p);
        }
    return pixels;
}

struct LumaChroma {
    double luminance = 0, chroma = 0;
};
struct RelativeMean {
    LumaChroma mean, error;  ///< error: standard, from the spread over pixels
};

/// Mean over pixels of value(pixel, channel) / (Y^2 + 0.01), with Y of `scale`; chroma is the sum
/// of its three channels.
template <class F>
[[nodiscard]] RelativeMean mean_relative(const std::vector<PixelMoments>& scale, const F& value) {
    const auto n = static_cast<double>(scale.size());
    LumaChroma sum, squares;
    for (size_t k = 0; k < scale.size(); ++k) {
        const double weight = 1 / (scale[k].mean[0] * scale[k].mean[0] + 0.01);
        const double l = value(k, 0) * weight;
        const double c = (value(k, 1) + value(k, 2) + value(k, 3)) * weight;
        sum.luminance += l, sum.chroma += c;
        squares.luminance += l * l, squares.chroma += c * c;
    }
    const auto error = [&](double s, double s2) { return std::sqrt((s2 - s * s / n) / n / n); };
    return {{sum.luminance / n, sum.chroma / n},
            {error(sum.luminance, squares.luminance), error(sum.chroma, squares.chroma)}};
}

/// Relative variance of one render.
[[nodiscard]] inline LumaChroma noise_of(const std::vector<PixelMoments>& pixels) {
    return mean_relative(pixels, [&](size_t k, size_t i) { return pixels[k].variance[i]; }).mean;
}

/// CPU seconds of a render on one thread.
[[nodiscard]] inline double timed_s(const integrator::PathTracer<>& tracer,
                                    const camera::Camera& camera, const integrator::RenderJob& job,
                                    Film& film) {
    integrator::RenderMonitor monitor;
    integrator::ThreadExecutor executor(1);
    const double start_s = io::process_cpu_s();
    static_cast<void>(integrator::render(tracer, camera, job, film, executor, monitor));
    return io::process_cpu_s() - start_s;
}

/// Of values that are not empty; sorts them.
[[nodiscard]] inline double median(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    const size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace petzval
