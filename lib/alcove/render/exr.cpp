#include "alcove/render/detail/exr_file.h"
#include "alcove/render/image.h"

#include <array>

namespace alcove {
namespace {

using Names = std::array<const char*, 3>;

void add_vectors(std::vector<ExrChannel>& channels, const Names& names, const std::vector<Vec3>& values,
                 Precision precision) {
    for (std::size_t c = 0; c < names.size(); ++c)
        channels.push_back({names[c], &values.front().x + c, 3, precision});
}

void add_grey(std::vector<ExrChannel>& channels, const Names& names, const std::vector<float>& values,
              Precision precision) {
    for (const char* name : names)
        channels.push_back({name, values.data(), 1, precision});
}

}

void write_exr(const Image& image, const std::filesystem::path& file, const ImageHeader& description,
               Precision precision) {
    std::vector<ExrChannel> channels{{"A", image.alpha.data(), 1, precision}};
    if (image.passes.has(Pass::beauty))
        add_vectors(channels, {"R", "G", "B"}, image.color, precision);
    if (image.passes.has(Pass::ao))
        add_grey(channels, {"AO.R", "AO.G", "AO.B"}, image.ao, precision);
    if (image.passes.has(Pass::convexity))
        add_grey(channels, {"Convexity.R", "Convexity.G", "Convexity.B"}, image.convexity, precision);
    if (image.passes.has(Pass::shadow))
        add_grey(channels, {"Shadow.R", "Shadow.G", "Shadow.B"}, image.shadow, precision);
    if (image.passes.has(Pass::depth))
        channels.push_back({"Z", image.depth.data(), 1, Precision::single});
    if (image.passes.has(Pass::normal))
        add_vectors(channels, {"N.X", "N.Y", "N.Z"}, image.normal, Precision::single);
    if (image.passes.has(Pass::position))
        add_vectors(channels, {"P.X", "P.Y", "P.Z"}, image.position, Precision::single);
    if (image.passes.has(Pass::steps))
        channels.push_back({"Steps.V", image.steps.data(), 1, Precision::single});
    if (image.passes.has(Pass::object))
        channels.push_back({"Object.V", image.object.data(), 1, Precision::single});
    write_exr_file(image.width, image.height, channels, description, true, file);
}

}
