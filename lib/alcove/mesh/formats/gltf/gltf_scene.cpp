#include "alcove/mesh/formats/gltf/gltf_scene.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/gltf/gltf_accessor.h"
#include "alcove/mesh/mesh.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace alcove {
namespace {

constexpr std::size_t max_instances = 1'000'000;

std::vector<double> numbers(const GltfValue& array, std::size_t count) {
    if (array.size() != count)
        array.fail(fmt::format("has {} numbers, not {}; export the file again", array.size(), count));
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = array[i].number();
    return values;
}

glm::dmat4 transform(const Vec3d& translation, glm::dquat rotation, const Vec3d& scale) {
    const double length = glm::length(rotation);
    rotation = length > 0.0 ? rotation / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
    glm::dmat4 matrix = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis)
        matrix[axis] *= scale[axis];
    matrix[3] = glm::dvec4(translation, 1.0);
    return matrix;
}

glm::dmat4 matrix_at(const double* values) {
    glm::dmat4 matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            matrix[column][row] = values[4 * column + row];
    return matrix;
}

glm::dmat4 local_transform(const GltfValue& node) {
    if (const std::optional<GltfValue> matrix = node.find("matrix"))
        return matrix_at(numbers(*matrix, 16).data());
    Vec3d translation(0.0), scale(1.0);
    glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
    if (const std::optional<GltfValue> t = node.find("translation")) {
        const std::vector<double> v = numbers(*t, 3);
        translation = {v[0], v[1], v[2]};
    }
    if (const std::optional<GltfValue> r = node.find("rotation")) {
        const std::vector<double> v = numbers(*r, 4);
        rotation = glm::dquat(v[3], v[0], v[1], v[2]);
    }
    if (const std::optional<GltfValue> s = node.find("scale")) {
        const std::vector<double> v = numbers(*s, 3);
        scale = {v[0], v[1], v[2]};
    }
    return transform(translation, rotation, scale);
}

bool is_finite(const glm::dmat4& matrix) {
    double sum = 0.0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            sum += matrix[column][row] - matrix[column][row];
    return sum == 0.0;
}

/// The transforms of the instances of EXT_mesh_gpu_instancing, relative to the node.
std::vector<glm::dmat4> instances_of(GltfFile& file, const GltfValue& attributes) {
    std::vector<float> translations, rotations, scales;
    std::size_t count = 0;
    const auto read = [&](const char* name, int components, std::vector<float>& values) {
        if (!attributes.has(name))
            return;
        const GltfValue index = attributes[name];
        const GltfAccessor accessor(file, index.target(file.root(), "accessors"), components, components);
        if (count != 0 && count != accessor.count())
            index.fail("has a different count from the other instance attributes; export the file again");
        count = accessor.count();
        if (count > max_instances)
            throw LimitError(fmt::format("{}: {}: {} instances are more than {}; split the scene",
                                         file.bytes().path().string(), index.place(), grouped(count),
                                         grouped(max_instances)));
        values = accessor.floats().all();
    };
    read("TRANSLATION", 3, translations);
    read("ROTATION", 4, rotations);
    read("SCALE", 3, scales);
    std::vector<glm::dmat4> instances;
    instances.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d translation(0.0), scale(1.0);
        glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            const int axis = static_cast<int>(k);
            if (!translations.empty())
                translation[axis] = translations[3 * i + k];
            if (!scales.empty())
                scale[axis] = scales[3 * i + k];
        }
        if (!rotations.empty())
            rotation = glm::dquat(rotations[4 * i + 3], rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2]);
        instances.push_back(transform(translation, rotation, scale));
    }
    return instances;
}

class SceneReader {
  public:
    explicit SceneReader(GltfFile& file) : file_(file), root_(file.root()) {}

    std::vector<GltfPlacement> read() {
        if (!root_.has("nodes"))
            return {};
        const GltfValue nodes = root_["nodes"];
        find_parents(nodes);
        find_transforms(nodes);
        find_visible(nodes);
        for (const std::size_t node : visited_)
            add(nodes[node], node);
        return std::move(placements_);
    }

  private:
    static constexpr std::size_t none = ~std::size_t{0};

    void find_parents(const GltfValue& nodes) {
        parents_.assign(nodes.size(), none);
        for (std::size_t n = 0; n < parents_.size(); ++n)
            if (const std::optional<GltfValue> children = nodes[n].find("children"))
                for (std::size_t c = 0; c < children->size(); ++c) {
                    const std::size_t child = (*children)[c].index(parents_.size());
                    if (parents_[child] != none || child == n)
                        (*children)[c].fail(fmt::format("node {} has two parents, or is its own ancestor; export the "
                                                        "file again",
                                                        child));
                    parents_[child] = n;
                }
    }

    std::vector<std::size_t> first_nodes() const {
        std::vector<std::size_t> first;
        if (root_.has("scenes") && root_["scenes"].size() > 0) {
            const GltfValue scenes = root_["scenes"];
            const GltfValue scene = scenes[root_.has("scene") ? root_["scene"].index(scenes.size()) : 0];
            if (const std::optional<GltfValue> nodes = scene.find("nodes"))
                for (std::size_t i = 0; i < nodes->size(); ++i)
                    first.push_back((*nodes)[i].index(parents_.size()));
        } else {
            for (std::size_t n = 0; n < parents_.size(); ++n)
                if (parents_[n] == none)
                    first.push_back(n);
        }
        return first;
    }

    /// Computes the transforms of all nodes that are not in a cycle, starting at the roots.
    void find_transforms(const GltfValue& nodes) {
        transforms_.assign(parents_.size(), glm::dmat4(1.0));
        std::vector<std::size_t> to_visit;
        for (std::size_t n = 0; n < parents_.size(); ++n)
            if (parents_[n] == none)
                to_visit.push_back(n);
        while (!to_visit.empty()) {
            const std::size_t n = to_visit.back();
            to_visit.pop_back();
            const glm::dmat4 local = local_transform(nodes[n]);
            transforms_[n] = parents_[n] == none ? local : transforms_[parents_[n]] * local;
            if (!is_finite(transforms_[n]))
                nodes[n].fail("its transform is not finite; export the file again");
            for_each_child(nodes[n], [&](std::size_t child) { to_visit.push_back(child); });
        }
    }

    /// Finds the nodes of the scene, depth first. Each is visited once, although a scene may list a node twice, or
    /// together with its ancestor.
    void find_visible(const GltfValue& nodes) {
        std::vector<char> seen(parents_.size(), 0);
        std::vector<std::size_t> to_visit = first_nodes();
        std::reverse(to_visit.begin(), to_visit.end());
        while (!to_visit.empty()) {
            const std::size_t n = to_visit.back();
            to_visit.pop_back();
            if (std::exchange(seen[n], 1))
                continue;
            visited_.push_back(n);
            const std::size_t old = to_visit.size();
            for_each_child(nodes[n], [&](std::size_t child) { to_visit.push_back(child); });
            std::reverse(to_visit.begin() + static_cast<std::ptrdiff_t>(old), to_visit.end());
        }
    }

    template <class F>
    void for_each_child(const GltfValue& node, const F& f) const {
        if (const std::optional<GltfValue> children = node.find("children"))
            for (std::size_t c = 0; c < children->size(); ++c)
                f((*children)[c].index(parents_.size()));
    }

    /// The names of a placement. They are limited in length and number, because they take memory for every instance.
    std::vector<std::string> names_of(std::size_t node, const GltfValue& mesh) const {
        constexpr std::size_t most_ancestors = 16;
        std::vector<std::string> names;
        const GltfValue nodes = root_["nodes"];
        for (std::size_t n = node, steps = 0; n != none && steps <= most_ancestors; n = parents_[n], ++steps)
            if (nodes[n].has("name"))
                names.push_back(nodes[n]["name"].text().substr(0, FaceGroup::most_letters));
        if (mesh.has("name"))
            names.push_back(mesh["name"].text().substr(0, FaceGroup::most_letters));
        return names;
    }

    void add(const GltfValue& node, std::size_t number) {
        if (!node.has("mesh"))
            return;
        GltfPlacement placement;
        placement.node = number;
        const GltfValue mesh = node["mesh"].target(root_, "meshes");
        placement.mesh = node["mesh"].count();
        placement.names = names_of(number, mesh);
        placement.to_scene = transforms_[number];
        if (node.has("skin")) {
            placement.is_skinned = true;
            placement.to_scene = bind_pose(node["skin"].target(root_, "skins"));
        }
        const std::optional<GltfValue> extensions = node.find("extensions");
        const std::optional<GltfValue> instancing =
            extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
        std::vector<glm::dmat4> instances{glm::dmat4(1.0)};
        if (instancing)
            instances = instances_of(file_, (*instancing)["attributes"]);
        for (const glm::dmat4& instance : instances) {
            if (placements_.size() == max_instances)
                throw LimitError(fmt::format("{}: more than {} instances; split the scene",
                                             file_.bytes().path().string(), grouped(max_instances)));
            placements_.push_back(placement);
            placements_.back().to_scene = placement.to_scene * instance;
            if (!is_finite(placements_.back().to_scene))
                node.fail("the transform of an instance is not finite; export the file again");
        }
    }

    /// The transform of a skinned mesh in its bind pose. In this pose, the product of a joint's transform and its
    /// inverse bind matrix is the same for all joints, so the first joint is enough.
    glm::dmat4 bind_pose(const GltfValue& skin) {
        const GltfValue joints = skin["joints"];
        const std::size_t joint = joints[0].index(parents_.size());
        glm::dmat4 inverse(1.0);
        if (skin.has("inverseBindMatrices")) {
            const GltfValue accessor = skin["inverseBindMatrices"].target(root_, "accessors");
            const std::string bytes = bytes_of_matrix(accessor["bufferView"].target(root_, "bufferViews"),
                                                      accessor.count_or("byteOffset", 0));
            std::array<float, 16> values{};
            std::memcpy(values.data(), bytes.data(), bytes.size());
            const std::vector<double> doubles(values.begin(), values.end());
            inverse = matrix_at(doubles.data());
        }
        const glm::dmat4 pose = transforms_[joint] * inverse;
        return is_finite(pose) ? pose : glm::dmat4(1.0);
    }

    std::string bytes_of_matrix(const GltfValue& view, std::size_t offset) {
        const FilePart bytes = file_.view(view);
        constexpr std::size_t size = 16 * sizeof(float);
        if (offset > bytes.size() || bytes.size() - offset < size)
            view.fail("is too short for a matrix; export the file again");
        return bytes.part(offset, size).read();
    }

    GltfFile& file_;
    GltfValue root_;
    std::vector<std::size_t> parents_, visited_;
    std::vector<glm::dmat4> transforms_;
    std::vector<GltfPlacement> placements_;
};

}

std::vector<GltfPlacement> placements_of(GltfFile& file) {
    return SceneReader(file).read();
}

}
