// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/develop.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "apps/request/option_names.h"
#include "apps/setup/camera/camera_report.h"
#include "core/spectrum/colour.h"
#include "integrator/render/noise_target.h"
#include "io/base/printable.h"
#include "io/build/build.h"
#include "io/image/spectral_layout.h"

namespace petzval::apps {
namespace {

/// Value for an infinite standard error: what reads EXR may scale and subtract it without getting
/// NaN.
constexpr float kUnknownError = std::numeric_limits<float>::max();

/// Samples whose spread tells a pixel's error: none where one was left out, as it is not known
/// which replicate it was dealt to.
SampleRange dealt_samples(const Film& film, uint32_t first, int x, int y) {
    return {first, first + (film.left_out(x, y) == 0 ? film.sample_count(x, y) : 0)};
}

/// Mean over the pixels with light of the standard error of their luminance, relative to it;
/// infinite where one has too few samples to tell. Pixels with samples that were left out do not
/// count.
float mean_relative_error(const Film& film, uint32_t first) {
    const Rect crop = film.crop();
    double sum = 0;
    uint64_t lit = 0;
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const V4f mean = film.colour(x, y);
            const float light = luminance({mean.x, mean.y, mean.z});
            if (!(light > 0) || film.left_out(x, y) > 0) continue;
            ++lit;
            sum += double(film.spectral()->luminance_error(film.offset(x, y),
                                                           dealt_samples(film, first, x, y))) /
                   light;
        }
    return lit > 0 ? static_cast<float>(sum / double(lit)) : 0.f;
}

void describe_spectrum(const Film& film, uint32_t first, io::Metadata& m) {
    const Bins& bins = film.spectral()->bins();
    m.emplace_back("spectralLayoutVersion", "1.0");
    m.emplace_back("emissiveUnits", "W.m^-2.sr^-1");
    m.emplace_back("petzval:bins", fmt::format("{:.9g}:{:.9g}:{:.9g}", bins.first_edge_nm,
                                               bins.last_edge_nm(), bins.width_nm));
    m.emplace_back("petzval:binScale", "S0 is the average over the bin in W.m^-2.sr^-1.nm^-1");
    m.emplace_back("petzval:replicates", static_cast<int>(kReplicates));
    m.emplace_back("petzval:stderr",
                   fmt::format("standard error of the mean; {:.9g} where it is not known: with "
                               "fewer than {} samples, or one that was left out",
                               kUnknownError, kReplicates));
    if (const float error = mean_relative_error(film, first); std::isfinite(error))
        m.emplace_back("petzval:meanRelativeError", error);
}

std::vector<std::string> channels_of(const Film& film, bool denoised) {
    std::vector<std::string> names = {"R", "G", "B", "A"};
    if (film.spectral()) {
        const Bins& bins = film.spectral()->bins();
        for (int i = 0; i < bins.count; ++i)
            names.push_back(io::spectral_channel(bins.centre_nm(i)));
        for (const char* name : {"XYZ.X", "XYZ.Y", "XYZ.Z", "stderr.R", "stderr.G", "stderr.B"})
            names.emplace_back(name);
    }
    if (film.keeps().blocks)
        for (const char* name : {"samples.N", "stderr.R", "stderr.G", "stderr.B"})
            if (std::find(names.begin(), names.end(), name) == names.end())
                names.emplace_back(name);
    if (denoised) {
        for (const char* name : {"denoised.R", "denoised.G", "denoised.B", "denoised.error"})
            names.emplace_back(name);
        for (int i = 0; film.spectral() && i < film.spectral()->bins().count; ++i)
            names.push_back("denoised." +
                            io::spectral_channel(film.spectral()->bins().centre_nm(i)));
    }
    for (const Aov aov : film.aovs()) {
        const AovInfo& info = aov_info(aov);
        for (int i = 0; i < info.channel_count; ++i) names.emplace_back(info.channels[i]);
    }
    return names;
}

/// Standard error of R, G and B, as if the n samples were independent: the squared difference of
/// the first half of the first P from these, and of these from all, have the sum (2 n - P) / P
/// times the variance. Of one pixel alone, so that it says little of a single one.
V3f stated_error(const Film& film, int x, int y) {
    const auto parts = film.parts(x, y);
    const V3f late = parts.means[0] - parts.means[1], last = parts.all - parts.means[0];
    const auto n = static_cast<float>(film.taken_count(x, y));
    const float power = static_cast<float>(std::bit_floor(film.taken_count(x, y))),
                share = power / (2 * n - power);
    V3f out(0.f);
    for (int i = 0; i < 3; ++i) out[i] = std::sqrt((late[i] * late[i] + last[i] * last[i]) * share);
    return out;
}

/// Writes the values of one pixel in the order of channels_of; returns where the next pixel's go.
float* develop_pixel(const Film& film, const DenoisedFilm* denoised, uint32_t first, int x, int y,
                     float* out) {
    const auto put = [&](const auto& values, int count) {
        for (int i = 0; i < count; ++i) *out++ = values[i];
    };
    put(film.colour(x, y), 4);
    if (const auto& spectral = film.spectral()) {
        const size_t at = film.offset(x, y);
        const uint32_t count = film.sample_count(x, y);
        spectral->bin_means(at, count, out);
        out += spectral->bins().count;
        put(spectral->xyz(at, count), 3);
        V3f error = spectral->standard_error(at, dealt_samples(film, first, x, y));
        for (int i = 0; i < 3; ++i) error[i] = std::min(error[i], kUnknownError);
        put(error, 3);
    }
    if (film.keeps().blocks) {
        *out++ = static_cast<float>(film.sample_count(x, y));
        if (!film.spectral()) put(stated_error(film, x, y), 3);
    }
    if (denoised) {
        const size_t at = denoised->picture.offset(x, y);
        put(denoised->picture.colour[at], 3);
        *out++ = denoised->error_about[at];
        if (film.spectral()) {
            const auto bins = static_cast<size_t>(film.spectral()->bins().count);
            out = std::copy_n(denoised->picture.bins.data() + at * bins, bins, out);
        }
    }
    for (size_t layer = 0; layer < film.aovs().size(); ++layer)
        put(film.aov(x, y, layer), aov_info(film.aovs()[layer]).channel_count);
    return out;
}

/// Layout of a film's picture.
io::PictureLayout layout_of(const Film& film, SampleRange samples,
                            std::vector<std::string> channels, const io::Metadata& of_render) {
    const Rect crop = film.crop();
    io::PictureLayout layout{.width = crop.width(),
                             .height = crop.height(),
                             .x = crop.x0,
                             .y = crop.y0,
                             .full_width = film.full_size().x,
                             .full_height = film.full_size().y,
                             .channels = std::move(channels),
                             .metadata = of_render};
    layout.metadata.emplace_back(kSamples, fmt::format("{}:{}", samples.first, samples.end));
    return layout;
}

}  // namespace

io::Metadata describe_render(const RenderSetup& setup, const integrator::RenderJob& job,
                             const integrator::PathOptions& options) {
    io::Metadata m{{"Software", io::program_version()},
                   {"petzval:sceneHash", fmt::format("{:016x}", setup.prepared.hash)},
                   {"petzval:seed", fmt::format("{}", job.seed)},
                   {"petzval:sampler", name_of(job.sampler)},
                   {"petzval:filter", name_of(job.filter.kind())},
                   {"petzval:filterRadius_px", job.filter.radius_px()},
                   {"petzval:maxDepth", options.max_depth},
                   {"petzval:maxClearDepth", options.max_specular_depth},
                   {"petzval:scale", setup.from.scale},
                   {"petzval:transparent", int(options.transparent)},
                   {"petzval:luminousEfficacy_lm_per_W", kLuminousEfficacy_lm_per_w}};
    if (job.noise) m.emplace_back(kNoiseTarget, static_cast<float>(job.noise->noise));
    if (job.denoised_error) m.emplace_back(kNoiseTarget, static_cast<float>(*job.denoised_error));
    if (job.clamp_nits) m.emplace_back("petzval:clamp_nits", *job.clamp_nits);
    for (const auto& [name, value] : setup.from.metadata) m.emplace_back(name, value);
    if (setup.from.exposure_is_auto) m.emplace_back(kFoundExposure, setup.from.exposure_ev);
    describe_camera(setup.from.camera, m);
    for (auto& [name, value] : m)
        if (auto* text = std::get_if<std::string>(&value)) *text = io::visible(*text);
    return m;
}

io::Picture colours_of(const Film& film, int channels, const DenoisedFilm* denoised) {
    const Rect crop = film.crop();
    io::Picture out;
    out.width = crop.width();
    out.height = crop.height();
    out.x = crop.x0;
    out.y = crop.y0;
    out.full_width = film.full_size().x;
    out.full_height = film.full_size().y;
    for (int i = 0; i < channels; ++i) out.channels.emplace_back(1, "RGBA"[i]);
    out.pixels.reserve(static_cast<size_t>(channels) * static_cast<size_t>(out.width) *
                       static_cast<size_t>(out.height));
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            V4f rgba = film.colour(x, y);
            if (denoised) {
                const V3f& rgb = denoised->picture.colour[denoised->picture.offset(x, y)];
                rgba = {rgb.x, rgb.y, rgb.z, rgba.w};
            }
            for (int i = 0; i < channels; ++i) out.pixels.push_back(rgba[i]);
        }
    return out;
}

io::PictureRows develop(const Film& film, SampleRange samples, const io::Metadata& of_render,
                        std::shared_ptr<const DenoisedFilm> denoised) {
    io::PictureLayout layout =
        layout_of(film, samples, channels_of(film, denoised != nullptr), of_render);
    if (film.spectral()) describe_spectrum(film, samples.first, layout.metadata);
    return {std::move(layout),
            [&film, crop = film.crop(), first = samples.first, denoised](int y, float* row) {
                for (int x = crop.x0; x < crop.x1; ++x)
                    row = develop_pixel(film, denoised.get(), first, x, crop.y0 + y, row);
            }};
}

io::PictureRows denoised_colours(const Film& film, SampleRange samples,
                                 const io::Metadata& of_render,
                                 std::shared_ptr<const DenoisedFilm> denoised) {
    return {layout_of(film, samples, {"R", "G", "B", "A"}, of_render),
            [&film, crop = film.crop(), denoised](int y, float* row) {
                for (int x = crop.x0; x < crop.x1; ++x) {
                    const V3f c =
                        denoised->picture.colour[denoised->picture.offset(x, crop.y0 + y)];
                    for (int i = 0; i < 3; ++i) *row++ = c[i];
                    *row++ = film.colour(x, crop.y0 + y).w;
                }
            }};
}

}  // namespace petzval::apps
