// SPDX-License-Identifier: Apache-2.0
#include "apps/state/finished_film.h"

#include "apps/setup/develop.h"
#include "io/image/picture_files.h"
#include "io/picture/seal.h"

namespace petzval {

PictureRows picture_for(const std::filesystem::path& path, const FinishedFilm& done) {
    Metadata metadata = done.facts.metadata;
    metadata.emplace_back(kLightHash,
                          light_hash(done.facts, FilmShape::of(done.film), done.samples));
    const PictureFormat format = picture_format(path);
    if (format != PictureFormat::Exr)
        metadata.emplace_back(kDisplayHash, display_hash(done.facts.display));
    if (format != PictureFormat::Png) metadata.emplace_back(kSealName, kUnsealed);
    return develop(done.film, done.samples, metadata);
}

}  // namespace petzval
