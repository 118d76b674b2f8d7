// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/input_files.h"

#include "io/base/error.h"
#include "io/file/assets.h"

namespace petzval::apps {

namespace fs = std::filesystem;

std::vector<io::NamedFile> input_files(const SceneRequest& r) {
    std::vector<io::NamedFile> files{{"the scene", r.scene}};
    const auto add = [&](const char* role, const auto& path) {
        if (path && !path->empty()) files.push_back({role, *path});
    };
    add("the file of ⟨env⟩", r.environment);
    add("the file of ⟨lens⟩", r.camera.lens);
    add("the file of ⟨aperture⟩", r.camera.aperture);
    for (const fs::path& file : r.camera.glasses) files.push_back({"the file of ⟨glasses⟩", file});
    files.push_back({"the file of ⟨illuminant⟩", r.spectral.illuminant});
    files.push_back({"the file of ⟨response⟩", r.spectral.response});
    return files;
}

std::vector<io::NamedFile> input_files(const io::GltfFile& file, const fs::path& scene) {
    std::vector<io::NamedFile> files;
    for (const fs::path& one : file.files) files.push_back({"a file of the scene", one});
    if (file.extras.sky)
        files.push_back({"the sky of the scene", scene.parent_path() / *file.extras.sky});
    for (const io::GltfCamera& camera : file.cameras)
        for (const auto& name : {camera.extras.lens, camera.extras.aperture})
            if (name) files.push_back({kCameraFile, scene.parent_path() / *name});
    return files;
}

std::vector<io::NamedFile> own_files() {
    std::vector<io::NamedFile> files;
    for (const char* folder : {"color", "glass", "lenses", "spectra"}) try {
            for (const auto& entry : fs::directory_iterator(io::asset(folder)))
                files.push_back({"a file of Petzval itself", entry.path()});
        } catch (const io::InputError&) {  // not installed: whoever needs it will say so
        }
    return files;
}

}  // namespace petzval::apps
