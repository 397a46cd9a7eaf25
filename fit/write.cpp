#include "write.h"

#include <fmt/format.h>

namespace alcove::fit {
namespace {

constexpr std::array<std::size_t, 2> reported_radii{1, 3}; // for each mesh: 20 % and 5 %

std::string row_of(const auto& values) {
    std::string text = "{{";
    for (Eigen::Index i = 0; i < values.size(); ++i)
        text += fmt::format("{}{:#.6g}f", i == 0 ? "" : i % 8 == 0 ? ",\n        " : ", ", values[i]);
    return text + "}}";
}

std::string network_of(const Network& network, std::string_view name) {
    const auto units = [&](std::size_t layer) { return network.layers[layer].weights.cols(); };
    std::string text = fmt::format("inline constexpr Network<{}, {}, {}> {}{{\n", units(0), units(1), units(2), name);
    for (const Layer& layer : network.layers) {
        text += "    {{{\n";
        for (Eigen::Index o = 0; o < layer.weights.rows(); ++o)
            text += "        " + row_of(layer.weights.row(o)) + ",\n";
        text += "    }},\n    " + row_of(layer.bias) + "},\n";
    }
    return text + "};\n";
}

struct Mean {
    Errors errors{};
    int meshes = 0;
};

Mean mean_of(const Fit& fit, bool fitted, std::size_t radius) {
    Mean mean;
    for (const MeshErrors& mesh : fit.errors)
        if (mesh.fitted == fitted) {
            mean.errors.deviation += mesh.at[radius].deviation;
            mean.errors.ten += mesh.at[radius].ten;
            mean.errors.twenty_four += mesh.at[radius].twenty_four;
            ++mean.meshes;
        }
    mean.errors.deviation /= mean.meshes;
    mean.errors.ten /= mean.meshes;
    mean.errors.twenty_four /= mean.meshes;
    return mean;
}

std::string percent(float radius) {
    return fmt::format("{:.3g} %", 100.0f * radius);
}

}

std::string table_of(const Fit& fit) {
    std::vector<std::string> fitted;
    for (const MeshErrors& mesh : fit.errors)
        if (mesh.fitted)
            fitted.push_back(mesh.name);
    std::string text =
        "/// The coefficients of the calibrated estimator. Written by build/fit/alcove_fit: do not edit.\n"
        "///\n/// Fitted to";
    std::size_t column = 100;
    for (const std::string& name : fitted) {
        if (column + name.size() > 105) {
            text += "\n///    ";
            column = 7;
        }
        text += " " + name;
        column += name.size() + 1;
    }
    text += "\n/// Mean RMSE over the held-out meshes, by radius, with 10 | 24 probes | the best constant:\n";
    for (std::size_t r = 0; r < radii.size(); ++r) {
        const Errors mean = mean_of(fit, false, r).errors;
        text += fmt::format("///     {}: {:.4f} | {:.4f} | {:.4f}\n", percent(radii[r]), mean.ten, mean.twenty_four,
                            mean.deviation);
    }
    text += "#pragma once\n\n"
            "#include \"alcove/occlusion/methods/calibrated_inputs.h\"\n"
            "#include \"alcove/occlusion/methods/network.h\"\n\n"
            "// clang-format off\n"
            "namespace alcove::calibrated_table {\n\n";
    text += network_of(fit.ten, "ten_probes") + "\n" + network_of(fit.twenty_four, "twenty_four_probes");
    return text + "\n}\n";
}

std::string report_of(const Fit& fit) {
    std::string text = R"(# Error of the calibrated estimator

Written by `build/fit/alcove_fit`, which fits the coefficients of `calibrated` and measures their error: do not edit.

The RMSE is against the reference ao, with 1,024 rays per vertex on the held-out meshes and 256 on the others, on the
grids that a bake uses by default. Half of the meshes, chosen by name, are held out: their errors are the ones that
matter. The standard deviation of the reference is the RMSE of the best constant. All meshes have the same weight.

## Mean over the meshes

| radius | meshes | standard deviation of the reference | 10 probes | 24 probes |
| --- | --- | --- | --- | --- |
)";
    for (const bool fitted : {false, true})
        for (std::size_t r = 0; r < radii.size(); ++r) {
            const Mean mean = mean_of(fit, fitted, r);
            text += fmt::format("| {} | {} {} | {:.4f} | {:.4f} | {:.4f} |\n", percent(radii[r]), mean.meshes,
                                fitted ? "fitted" : "held out", mean.errors.deviation, mean.errors.ten,
                                mean.errors.twenty_four);
        }
    text += "\n## Each mesh\n\n| mesh | fitted |";
    std::string rule = "| --- | --- |";
    for (const std::size_t r : reported_radii) {
        text += fmt::format(" {}: standard deviation | 10 probes | 24 probes |", percent(radii[r]));
        rule += " --- | --- | --- |";
    }
    text += "\n" + rule + "\n";
    for (const MeshErrors& mesh : fit.errors) {
        text += fmt::format("| {} | {} |", mesh.name, mesh.fitted ? "yes" : "no");
        for (const std::size_t r : reported_radii)
            text += fmt::format(" {:.4f} | {:.4f} | {:.4f} |", mesh.at[r].deviation, mesh.at[r].ten,
                                mesh.at[r].twenty_four);
        text += "\n";
    }
    return text;
}

}
