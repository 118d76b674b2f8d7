// SPDX-License-Identifier: Apache-2.0
#include "apps/state/finished_film.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/setup/develop.h"
#include "io/image/picture_files.h"
#include "io/picture/seal.h"

namespace petzval::apps {

std::optional<integrator::NoiseReport> reached_noise(const RenderFacts& facts, const Film& film,
                                                     SampleRange samples) {
    if (!facts.noise) return std::nullopt;
    return integrator::noise_report(film, *facts.noise, samples.end);
}

std::optional<std::string> left_out_text(const Film& film) {
    const Film::LeftOut bad = film.left_out();
    if (bad.count() == 0) return std::nullopt;
    std::string text;
    if (bad.not_finite > 0) text = fmt::format("{} samples were not finite", bad.not_finite);
    if (bad.too_large > 0)
        text += fmt::format(
            "{}{} samples were brighter than {:.2g} nits{}, which is more than a film holds",
            text.empty() ? "" : "; ", bad.too_large, FilmSum::kLimit,
            film.spectral() ? fmt::format(", or than {:.2g} W/(m2 sr nm)", SpectralSum::kLimit)
            : film.aovs().empty() ? ""
                                  : ", or a layer was as large");
    text += fmt::format("; they are left out, the first is sample {} of pixel {},{}", bad.index,
                        bad.x, bad.y);
    if (bad.too_large > 0) text += "; ⟨clamp⟩ keeps them, or give the lights less strength";
    return "warning: " + text;
}

io::PictureRows picture_for(const std::filesystem::path& path, const FinishedFilm& done) {
    io::Metadata metadata = done.facts.metadata;
    metadata.emplace_back(kLightHash,
                          light_hash(done.facts, io::FilmShape::of(done.film), done.samples));
    if (const auto& noise = done.noise; noise && std::isfinite(noise->noise)) {
        metadata.emplace_back("petzval:noise", static_cast<float>(noise->noise));
        metadata.emplace_back("petzval:noiseOfWorstCell", static_cast<float>(noise->worst_cell));
        metadata.emplace_back("petzval:noiseFloor_nits", static_cast<float>(noise->floor_nits));
        metadata.emplace_back("petzval:noiseCellsLeft", static_cast<int>(noise->left));
        metadata.emplace_back("petzval:meanSamples", static_cast<float>(noise->mean_samples));
    }
    const io::PictureFormat format = io::picture_format(path);
    if (format != io::PictureFormat::Exr)
        metadata.emplace_back(kDisplayHash, display_hash(done.facts.display));
    if (format != io::PictureFormat::Png) metadata.emplace_back(io::kSealName, io::kUnsealed);
    if (const auto& denoised = done.denoised) {
        metadata.emplace_back("petzval:denoisedError", static_cast<float>(denoised->error.value()));
        metadata.emplace_back("petzval:denoisedErrorAtMost",
                              static_cast<float>(denoised->error.most()));
        metadata.emplace_back("petzval:denoisedFloor_nits",
                              static_cast<float>(denoised->floor_nits));
        if (format != io::PictureFormat::Exr)
            return denoised_colours(done.film, done.samples, metadata, denoised);
    }
    return develop(done.film, done.samples, metadata, done.denoised);
}

}  // namespace petzval::apps
