// SPDX-License-Identifier: Apache-2.0
#include "io/image/display_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/file/read_file.h"
#include "io/file/text_lines.h"
#include "io/image/ocio_config.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
namespace ocio = OCIO_NAMESPACE;

/// A table in XML (CTF), which may refer to others; empty for any other. An XML text begins with a
/// tag, behind blanks and the mark of its encoding.
std::string xml_of(const fs::path& table) {
    constexpr std::string_view kBefore(" \t\r\n\0\xEF\xBB\xBF\xFE\xFF", 10);
    const InputFile file(table);
    std::array<uint8_t, 4096> part;
    for (uint64_t at = 0; at < file.size(); at += part.size())
        for (size_t i = 0, end = file.read(part, at); i < end; ++i) {
            if (kBefore.find(static_cast<char>(part[i])) != kBefore.npos) continue;
            if (part[i] != '<') return "";
            const FileBytes all = read_file(table);
            return {all.bytes.begin(), all.bytes.end()};
        }
    return "";
}

/// Values of the attributes "path" of an XML text. Throws InputError for what OpenColorIO's parser
/// may read otherwise than this, and so see another file: UTF-16, entities, other alphabets.
std::vector<std::string> paths_in(const std::string& xml, const fs::path& table) {
    const std::string small = lower(xml);
    const auto has = [&](std::string_view text) { return small.find(text) != small.npos; };
    const auto refuse = [&] {
        return InputError(table.string(), "",
                          "refers to others in a way that is not read (UTF-16, a document type, an "
                          "entity in a path); save it as plain UTF-8");
    };
    if (has("<!doctype") || has(std::string_view("\0", 1))) throw refuse();
    const bool utf8 = !has("encoding") || has("utf-8");
    std::vector<std::string> paths;
    constexpr std::string_view kName = "path", kBlanks = " \t\r\n";
    for (size_t at = 0; (at = small.find(kName, at)) != small.npos;) {
        at += kName.size();
        const size_t equals = small.find_first_not_of(kBlanks, at);
        if (equals == small.npos || small[equals] != '=') continue;
        const size_t quote = small.find_first_not_of(kBlanks, equals + 1);
        if (quote == small.npos || (small[quote] != '"' && small[quote] != '\'')) continue;
        const size_t end = small.find(small[quote], quote + 1);
        if (end == small.npos) break;
        const std::string& path = paths.emplace_back(xml.substr(quote + 1, end - quote - 1));
        const bool ascii = std::none_of(path.begin(), path.end(), [](char c) { return c < 0; });
        if (path.find('&') != path.npos || !(ascii || utf8)) throw refuse();
    }
    return paths;
}

/// Collects the files of a configuration, and refuses those that are pipes or devices.
class Tables {
  public:
    Tables(const ocio::Config& config, std::vector<fs::path>& files)
        : config_(config), files_(files) {}

    void add_all() {
        constexpr auto kSpaces = ocio::SEARCH_REFERENCE_SPACE_ALL;
        for (int i = 0; i < config_.getNumColorSpaces(kSpaces, ocio::COLORSPACE_ALL); ++i) {
            const auto space = config_.getColorSpace(
                config_.getColorSpaceNameByIndex(kSpaces, ocio::COLORSPACE_ALL, i));
            add(space->getTransform(ocio::COLORSPACE_DIR_TO_REFERENCE));
            add(space->getTransform(ocio::COLORSPACE_DIR_FROM_REFERENCE));
        }
        for (int i = 0; i < config_.getNumLooks(); ++i) {
            const auto look = config_.getLook(config_.getLookNameByIndex(i));
            add(look->getTransform());
            add(look->getInverseTransform());
        }
        for (int i = 0; i < config_.getNumViewTransforms(); ++i) {
            const auto view = config_.getViewTransform(config_.getViewTransformNameByIndex(i));
            add(view->getTransform(ocio::VIEWTRANSFORM_DIR_TO_REFERENCE));
            add(view->getTransform(ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE));
        }
        for (int i = 0; i < config_.getNumNamedTransforms(ocio::NAMEDTRANSFORM_ALL); ++i) {
            const auto named = config_.getNamedTransform(
                config_.getNamedTransformNameByIndex(ocio::NAMEDTRANSFORM_ALL, i));
            add(named->getTransform(ocio::TRANSFORM_DIR_FORWARD));
            add(named->getTransform(ocio::TRANSFORM_DIR_INVERSE));
        }
    }

  private:
    void add(const ocio::ConstTransformRcPtr& transform) {
        if (const auto group = ocio::DynamicPtrCast<const ocio::GroupTransform>(transform))
            for (int i = 0; i < group->getNumTransforms(); ++i) add(group->getTransform(i));
        if (const auto file = ocio::DynamicPtrCast<const ocio::FileTransform>(transform))
            add_file(file->getSrc());
    }
    void add_file(const std::string& name) {
        fs::path path;
        try {
            path = config_.getCurrentContext()->resolveFileLocation(name.c_str());
        } catch (const ocio::Exception&) {  // is not there: nothing to lose
            return;
        }
        if (std::find(files_.begin(), files_.end(), path) != files_.end()) return;
        if (const InputFile file(path); !file.error().empty())
            throw InputError(files_.front().string(), "", "names {}, which {}", path.string(),
                             file.error());
        files_.push_back(path);
        for (const std::string& other : paths_in(xml_of(path), path)) add_file(other);
    }

    const ocio::Config& config_;
    std::vector<fs::path>& files_;
};

}  // namespace

OcioConfig open_ocio_config(const fs::path& path) {
    if (const InputFile file(path); !file.error().empty())
        throw InputError(path.string(), "", "cannot be used: " + file.error());
    try {
        OcioConfig out{ocio::Config::CreateFromFile(path.c_str()), {path}};
        Tables(*out.config, out.files).add_all();
        return out;
    } catch (const ocio::Exception& error) {
        throw InputError(path.string(), "", "cannot be used: " + first_line(error.what()));
    }
}

std::vector<fs::path> display_files(const fs::path& config) {
    try {
        return open_ocio_config(config).files;
    } catch (const InputError&) {  // its user says what is wrong with it
        return {config};
    }
}

}  // namespace petzval::io
