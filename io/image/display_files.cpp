// SPDX-License-Identifier: Apache-2.0
#include "io/image/display_files.h"

#include <OpenColorIO/OpenColorIO.h>

namespace petzval {
namespace {

namespace ocio = OCIO_NAMESPACE;

class Tables {
  public:
    Tables(const ocio::Config& config, std::vector<std::filesystem::path>& files)
        : config_(config), files_(files) {}

    void add(const ocio::ConstTransformRcPtr& transform) {
        if (const auto group = ocio::DynamicPtrCast<const ocio::GroupTransform>(transform))
            for (int i = 0; i < group->getNumTransforms(); ++i) add(group->getTransform(i));
        const auto file = ocio::DynamicPtrCast<const ocio::FileTransform>(transform);
        if (!file) return;
        try {
            files_.emplace_back(config_.getCurrentContext()->resolveFileLocation(file->getSrc()));
        } catch (const ocio::Exception&) {  // is not there: nothing to lose
        }
    }

  private:
    const ocio::Config& config_;
    std::vector<std::filesystem::path>& files_;
};

void add_tables(const ocio::Config& config, Tables& tables) {
    constexpr auto kSpaces = ocio::SEARCH_REFERENCE_SPACE_ALL;
    for (int i = 0; i < config.getNumColorSpaces(kSpaces, ocio::COLORSPACE_ALL); ++i) {
        const auto space =
            config.getColorSpace(config.getColorSpaceNameByIndex(kSpaces, ocio::COLORSPACE_ALL, i));
        tables.add(space->getTransform(ocio::COLORSPACE_DIR_TO_REFERENCE));
        tables.add(space->getTransform(ocio::COLORSPACE_DIR_FROM_REFERENCE));
    }
    for (int i = 0; i < config.getNumLooks(); ++i) {
        const auto look = config.getLook(config.getLookNameByIndex(i));
        tables.add(look->getTransform());
        tables.add(look->getInverseTransform());
    }
    for (int i = 0; i < config.getNumViewTransforms(); ++i) {
        const auto view = config.getViewTransform(config.getViewTransformNameByIndex(i));
        tables.add(view->getTransform(ocio::VIEWTRANSFORM_DIR_TO_REFERENCE));
        tables.add(view->getTransform(ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE));
    }
}

}  // namespace

std::vector<std::filesystem::path> display_files(const std::filesystem::path& config) {
    std::vector<std::filesystem::path> files{config};
    try {
        const auto loaded = ocio::Config::CreateFromFile(config.c_str());
        Tables tables(*loaded, files);
        add_tables(*loaded, tables);
    } catch (const ocio::Exception&) {  // its user says what is wrong with it
    }
    return files;
}

}  // namespace petzval
