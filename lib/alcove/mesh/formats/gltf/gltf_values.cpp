#include "alcove/mesh/formats/gltf/gltf_values.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/srgb.h"
#include "alcove/mesh/files.h"
#include "alcove/mesh/normals.h"

#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace alcove {
namespace {

/// A node that shows a mesh, and its placements of the mesh. There are several with EXT_mesh_gpu_instancing.
struct Instance {
    std::size_t node;
    std::vector<std::size_t> placements;
};

/// The values of the vertices of an instance, one block (GltfVertices) after another.
struct InstanceValues {
    std::vector<std::vector<float>> attributes;
    std::vector<Color> colors;
    double mean = 0.0; ///< of the first attribute
};

double mean_of(const std::vector<float>& values) {
    return values.empty() ? 0.0
                          : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The RMSE between two sets of values, divided by their range.
double difference(const std::vector<float>& a, const std::vector<float>& b, double range) {
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += (double(a[i]) - double(b[i])) * (double(a[i]) - double(b[i]));
    return a.empty() || range == 0.0 ? 0.0 : std::sqrt(squares / static_cast<double>(a.size())) / range;
}

class ValueWriter {
  public:
    ValueWriter(GltfOutput& output, const GltfDocument& document, const Mesh& mesh)
        : output_(output), document_(document), mesh_(mesh) {
        for (const Attribute& attribute : mesh.attributes)
            if (attribute.components > 4) {
                messages_.push_back("not stored in glTF: attribute " + in_quotes(attribute.name) +
                                    ", which has more than four components");
            } else if (attribute.name != "quality") { // `quality` is for MeshLab and equals ao
                attributes_.push_back(&attribute);
                double range = 1.0;
                if (attribute.name == "thickness")
                    range = *std::max_element(attribute.values.begin(), attribute.values.end());
                ranges_.push_back(range);
            }
        if (colors_are_ao(mesh))
            for (std::size_t i = 0; i < attributes_.size(); ++i)
                if (attributes_[i]->name == "ao")
                    greys_from_ = i;
        made_before_ =
            std::any_of(mesh.added_comments.begin(), mesh.added_comments.end(), [&](const std::string& comment) {
                return !document.comment(comment.substr(0, comment.find(' ') + 1)).empty();
            });
        if (made_before_)
            count_uses();
        blocks_of_.resize(document.placements.size());
        for (std::size_t b = 0; b < document.vertices.size(); ++b)
            blocks_of_[document.vertices[b].placement].push_back(b);
    }

    std::vector<std::string> write() {
        std::map<std::size_t, std::vector<Instance>> instances; // by mesh
        for (std::size_t p = 0; p < document_.placements.size(); ++p) {
            if (blocks_of_[p].empty())
                continue;
            const GltfPlacement& placement = document_.placements[p];
            std::vector<Instance>& all = instances[placement.mesh];
            if (all.empty() || all.back().node != placement.node)
                all.push_back({placement.node, {}});
            all.back().placements.push_back(p);
        }
        for (const auto& [mesh, all] : instances)
            write_mesh(mesh, all);
        separate_compressed();
        report();
        return std::move(messages_);
    }

  private:
    bool is_baked(const Instance& instance) const {
        if (mesh_.baked_vertices.empty())
            return true;
        return std::any_of(instance.placements.begin(), instance.placements.end(), [&](std::size_t p) {
            return std::any_of(blocks_of_[p].begin(), blocks_of_[p].end(), [&](std::size_t b) {
                const auto first =
                    mesh_.baked_vertices.begin() + static_cast<std::ptrdiff_t>(document_.vertices[b].first);
                return std::any_of(first, first + static_cast<std::ptrdiff_t>(document_.vertices[b].count),
                                   [](std::uint8_t baked) { return baked != 0; });
            });
        });
    }

    /// The mean values over the placements of an instance. Directions are transformed to the space of the node.
    InstanceValues values_of(const Instance& instance) const {
        InstanceValues values;
        for (const Attribute* attribute : attributes_) {
            std::vector<float> sums;
            for (const std::size_t p : instance.placements) {
                std::vector<float> own;
                for (const std::size_t b : blocks_of_[p])
                    append(own, attribute->values, static_cast<std::size_t>(attribute->components), b);
                if (attribute->name == "bent_normal")
                    to_node(own, document_.placements[p].to_scene);
                sums.resize(own.size(), 0.0f);
                std::transform(own.begin(), own.end(), sums.begin(), sums.begin(), std::plus());
            }
            for (float& sum : sums)
                sum /= static_cast<float>(instance.placements.size());
            if (attribute->name == "bent_normal" && instance.placements.size() > 1)
                to_node(sums, glm::dmat4(1.0));
            values.attributes.push_back(std::move(sums));
        }
        values.mean = values.attributes.empty() ? 0.0 : mean_of(values.attributes.front());
        if (!mesh_.added_colors.empty())
            values.colors = colors_of(instance);
        return values;
    }

    /// The mean colours over the placements of an instance, computed in linear light.
    std::vector<Color> colors_of(const Instance& instance) const {
        std::vector<Color> colors;
        std::vector<glm::vec4> sums;
        for (const std::size_t p : instance.placements) {
            colors.clear();
            for (const std::size_t b : blocks_of_[p])
                append(colors, mesh_.added_colors, 1, b);
            if (instance.placements.size() == 1)
                return colors;
            sums.resize(colors.size(), glm::vec4(0.0f));
            for (std::size_t v = 0; v < colors.size(); ++v)
                for (int c = 0; c < 4; ++c) {
                    const double byte = colors[v][static_cast<std::size_t>(c)] / 255.0;
                    sums[v][c] += static_cast<float>(c < 3 ? decode_srgb(byte) : byte);
                }
        }
        for (std::size_t v = 0; v < colors.size(); ++v) {
            const glm::vec4 mean = sums[v] / static_cast<float>(instance.placements.size());
            colors[v] = srgb_color(Vec3(mean), mean.a);
        }
        return colors;
    }

    template <class T>
    void append(std::vector<T>& to, const std::vector<T>& values, std::size_t components, std::size_t block) const {
        const GltfVertices& vertices = document_.vertices[block];
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(vertices.first * components);
        to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(vertices.count * components));
    }

    /// Transforms directions to the space of the node. A shader transforms them back as it transforms normals.
    static void to_node(std::vector<float>& directions, const glm::dmat4& to_scene) {
        const glm::dmat3 back = glm::transpose(glm::dmat3(to_scene));
        for (std::size_t i = 0; i + 2 < directions.size(); i += 3) {
            const Vec3 local = unit_or_zero(back * Vec3d(directions[i], directions[i + 1], directions[i + 2]));
            std::copy_n(&local.x, 3, directions.data() + i);
        }
    }

    double difference_of(const InstanceValues& a, const InstanceValues& b) const {
        // A quick test first: the RMSE is at least the difference of the means.
        double largest = ranges_.empty() || ranges_[0] == 0.0 ? 0.0 : std::fabs(a.mean - b.mean) / ranges_[0];
        for (std::size_t i = 0; i < attributes_.size() && largest <= mesh_.instance_error; ++i)
            largest = std::max(largest, difference(a.attributes[i], b.attributes[i], ranges_[i]));
        return largest;
    }

    void write_mesh(std::size_t mesh, const std::vector<Instance>& instances) {
        struct Shared {
            InstanceValues values;
            std::size_t mesh;
        };
        std::vector<Shared> all;
        const bool keeps_original =
            std::any_of(instances.begin(), instances.end(), [&](const Instance& i) { return !is_baked(i); });
        for (const Instance& instance : instances) {
            if (!is_baked(instance))
                continue;
            InstanceValues values = values_of(instance);
            std::size_t own = all.size();
            for (std::size_t s = 0; s < all.size() && own == all.size(); ++s)
                if (const double by = difference_of(all[s].values, values); by <= mesh_.instance_error) {
                    own = s;
                    largest_shared_ = std::max(largest_shared_, by);
                    ++shared_;
                }
            if (own == all.size()) {
                const bool copies = !all.empty() || keeps_original;
                if (copies)
                    output_.json()["meshes"].push_back(Json(document_.file->root()["meshes"][mesh].json()));
                copied_ += copies;
                all.push_back({std::move(values), copies ? output_.json()["meshes"].size() - 1 : mesh});
                add_to_mesh(all.back().mesh, all.back().values, blocks_of_[instance.placements.front()]);
            }
            if (all[own].mesh != mesh)
                output_.json()["nodes"][instance.node]["mesh"] = all[own].mesh;
        }
    }

    void add_to_mesh(std::size_t mesh, const InstanceValues& values, const std::vector<std::size_t>& blocks) {
        std::size_t first = 0;
        for (const std::size_t b : blocks) {
            const GltfVertices& vertices = document_.vertices[b];
            Json& primitives = output_.json()["meshes"][mesh]["primitives"];
            const auto set = [&](const std::string& name, std::size_t accessor) {
                for (const std::size_t p : vertices.primitives) {
                    primitives[p]["attributes"][name] = accessor;
                    // Otherwise programs would read the old values from the compressed data.
                    if (const auto draco = Json::json_pointer("/extensions/KHR_draco_mesh_compression/attributes");
                        primitives[p].contains(draco))
                        primitives[p][draco].erase(name);
                }
            };
            // The accessor that an earlier bake wrote, unless other attributes use it too, as those of a new copy of
            // the mesh do.
            const auto earlier = [&](const std::string& name) -> std::optional<std::size_t> {
                const Json& attributes = primitives[vertices.primitives.front()]["attributes"];
                if (!made_before_ || mesh >= document_.file->root()["meshes"].size() || !attributes.contains(name) ||
                    uses_.at(attributes[name]) > vertices.primitives.size())
                    return {};
                return attributes[name].get<std::size_t>();
            };
            for (std::size_t i = 0; i < attributes_.size(); ++i) {
                const auto components = static_cast<std::size_t>(attributes_[i]->components);
                const std::string name = gltf_attribute_name(attributes_[i]->name);
                const auto own =
                    std::span(values.attributes[i]).subspan(first * components, vertices.count * components);
                constexpr int float32 = 5126;
                if (const std::optional<std::size_t> old = earlier(name);
                    old &&
                    output_.overwrite(*old, float32, {reinterpret_cast<const char*>(own.data()), own.size_bytes()}))
                    continue;
                if (primitives[vertices.primitives.front()]["attributes"].contains(name))
                    ++replaced_[name];
                set(name, output_.add_floats(own, components));
            }
            if (greys_from_ || !values.colors.empty()) {
                const auto colors =
                    greys_from_
                        ? linear_greys(std::span(values.attributes[*greys_from_]).subspan(first, vertices.count))
                        : linear_colors(std::span(values.colors).subspan(first, vertices.count), mesh_.added_encoding);
                constexpr int uint16 = 5123;
                const std::string_view bytes(reinterpret_cast<const char*>(colors.data()),
                                             colors.size() * sizeof(colors[0]));
                if (const std::optional<std::size_t> old = earlier("COLOR_0");
                    !old || !output_.overwrite(*old, uint16, bytes))
                    set("COLOR_0", output_.add_colors(colors));
            }
            first += vertices.count;
        }
    }

    /// Primitives may share compressed data but not the added values. Gives each such primitive its own buffer view of
    /// the same bytes, because three.js shows the same values for all primitives that share a buffer view.
    void separate_compressed() {
        const auto view = Json::json_pointer("/extensions/KHR_draco_mesh_compression/bufferView");
        const Json& old = document_.file->root().json()["meshes"];
        Json& meshes = output_.json()["meshes"];
        std::map<std::size_t, Json> attributes; // of the first primitive with each view
        for (std::size_t m = 0; m < meshes.size(); ++m)
            for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
                Json& primitive = meshes[m]["primitives"][p];
                if (!primitive.contains(view))
                    continue;
                const auto number = primitive[view].get<std::size_t>();
                const Json& first = attributes.try_emplace(number, primitive["attributes"]).first->second;
                if (first == primitive["attributes"] || (m < old.size() && old[m]["primitives"][p] == primitive))
                    continue;
                Json& views = output_.json()["bufferViews"];
                views.push_back(Json(views.at(number)));
                primitive[view] = views.size() - 1;
            }
    }

    /// Counts the primitives of the file that use each accessor as an attribute.
    void count_uses() {
        for (const Json& mesh : document_.file->root().json()["meshes"])
            for (const Json& primitive : mesh["primitives"])
                for (const Json& accessor : primitive["attributes"])
                    ++uses_[accessor];
    }

    void report() {
        if (copied_ > 0)
            messages_.push_back(
                copied_ == 1 ? "1 instance received its own copy of the mesh, because its values differ from those "
                               "of other instances"
                             : grouped(copied_) + " instances received their own copies of the mesh, because "
                                                  "their values differ from those of other instances");
        if (shared_ > 0)
            messages_.push_back(fmt::format("{} the values of another instance of the same mesh; they differ by an "
                                            "RMSE of at most {:.2g}",
                                            counted(shared_, "instance shares", "instances share"), largest_shared_));
        for (const auto& [name, count] : replaced_) {
            if (!made_before_)
                messages_.push_back("the attribute " + in_quotes(name) + " of the input is replaced");
        }
    }

    GltfOutput& output_;
    const GltfDocument& document_;
    const Mesh& mesh_;
    std::vector<const Attribute*> attributes_;
    std::vector<double> ranges_;
    std::optional<std::size_t> greys_from_;           ///< the attribute that COLOR_0 shows
    std::vector<std::vector<std::size_t>> blocks_of_; ///< indices into GltfDocument::vertices, by placement
    bool made_before_ = false;                        ///< whether an earlier bake made values in the file
    std::map<std::size_t, std::size_t> uses_;
    std::map<std::string, std::size_t> replaced_;
    std::size_t copied_ = 0, shared_ = 0;
    double largest_shared_ = 0.0;
    std::vector<std::string> messages_;
};

}

std::string gltf_attribute_name(std::string_view name) {
    std::string upper = fmt::format("_{}", name);
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return upper;
}

std::vector<std::array<std::uint16_t, 4>> linear_colors(std::span<const Color> colors, ColorEncoding encoding) {
    constexpr double most = 65535.0;
    std::array<std::uint16_t, 256> linear{}, raw{};
    for (std::size_t i = 0; i < linear.size(); ++i) {
        const double value = static_cast<double>(i) / 255.0;
        raw[i] = static_cast<std::uint16_t>(std::lround(most * value));
        linear[i] = encoding == ColorEncoding::raw ? raw[i]
                                                   : static_cast<std::uint16_t>(std::lround(most * decode_srgb(value)));
    }
    std::vector<std::array<std::uint16_t, 4>> values;
    values.reserve(colors.size());
    for (const Color& c : colors)
        values.push_back({linear[c[0]], linear[c[1]], linear[c[2]], raw[c[3]]});
    return values;
}

bool colors_are_ao(const Mesh& mesh) {
    const Attribute* ao = mesh.find_attribute("ao");
    return ao != nullptr && ao->components == 1 && !mesh.added_colors.empty() &&
           mesh.added_colors == grey_colors(ao->values, mesh.added_encoding);
}

std::vector<std::array<std::uint16_t, 4>> linear_greys(std::span<const float> values) {
    constexpr float most = 65535.0f;
    std::vector<std::array<std::uint16_t, 4>> greys;
    greys.reserve(values.size());
    for (const float value : values) {
        const auto grey = static_cast<std::uint16_t>(std::lround(most * std::clamp(value, 0.0f, 1.0f)));
        greys.push_back({grey, grey, grey, static_cast<std::uint16_t>(most)});
    }
    return greys;
}

std::vector<std::string> add_values(GltfOutput& output, const GltfDocument& document, const Mesh& mesh) {
    return ValueWriter(output, document, mesh).write();
}

void add_comments(Json& owner, std::span<const std::string> added) {
    if (added.empty() || !owner.is_object())
        return;
    Json& extras = owner["extras"];
    if (!extras.is_null() && (!extras.is_object() || (extras.contains("comments") && !extras["comments"].is_array())))
        return; // these extras belong to another program
    Json comments = Json::array();
    if (extras.is_object() && extras.contains("comments"))
        comments = extras["comments"];
    for (const std::string& comment : added) {
        const std::string program = comment.substr(0, comment.find(' ') + 1);
        Json kept = Json::array();
        for (const Json& line : comments)
            if (!line.is_string() || !line.get_ref<const std::string&>().starts_with(program))
                kept.push_back(line);
        kept.push_back(comment);
        comments = std::move(kept);
    }
    extras["comments"] = std::move(comments);
}

}
