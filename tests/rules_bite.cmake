# Tests that layering.cmake and sizes.cmake detect violations. Each case breaks one rule in a small generated tree; the
# script must fail and name the file. The unbroken tree must pass.
#
#     cmake -D SCRATCH=<directory> -P rules_bite.cmake
cmake_minimum_required(VERSION 3.25)
set(tree ${SCRATCH}/tree)

function(make_tree)
    file(REMOVE_RECURSE ${tree})
    file(WRITE ${tree}/lib/alcove/alcove.h "#include \"alcove/base/types.h\"\n#include \"alcove/field/field.h\"\n")
    file(WRITE ${tree}/lib/alcove/base/types.h "#include <glm/vec3.hpp>\n#include <vector>\n")
    file(WRITE ${tree}/lib/alcove/grid/detail/vdb_grid.h "#include <openvdb/openvdb.h>\n")
    file(WRITE ${tree}/lib/alcove/grid/band.cpp "#include \"alcove/grid/detail/vdb_grid.h\"\n")
    file(WRITE ${tree}/lib/alcove/field/field.h "#include \"alcove/base/types.h\"\n")
    file(WRITE ${tree}/lib/alcove/field/detail/bricks.h "#include \"alcove/field/field.h\"\n")
    file(WRITE ${tree}/lib/alcove/field/detail/bricks.cpp
         "#include \"alcove/field/detail/bricks.h\"\n#include \"alcove/grid/detail/vdb_grid.h\"\n")
    file(WRITE ${tree}/apps/alcove/main.cpp "#include \"options.h\"\n#include \"alcove/bake/bake.h\"\n")
    file(WRITE ${tree}/docs/architecture.md "| `lib/alcove/base` | a |\n| `lib/alcove/grid` | b |\n"
         "| `lib/alcove/grid/detail` | c |\n| `lib/alcove/field` | d |\n| `lib/alcove/field/detail` | e |\n")
endfunction()

# Runs a rule on the tree. The output must contain `expected`; if that is empty, the rule must pass.
function(check rule expected)
    execute_process(COMMAND ${CMAKE_COMMAND} -D TREE=${tree} -P ${CMAKE_CURRENT_LIST_DIR}/${rule}.cmake
                    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    string(FIND "${output}" "${expected}" at)
    if(expected STREQUAL "" AND NOT status EQUAL 0)
        message(FATAL_ERROR "${rule} fails on an unbroken tree:\n${output}")
    elseif(NOT expected STREQUAL "" AND (status EQUAL 0 OR at EQUAL -1))
        message(FATAL_ERROR "${rule} does not report '${expected}' but:\n${output}")
    endif()
endfunction()

# Writes one file into an unbroken tree and expects the rule to report it.
function(refused rule file content expected)
    make_tree()
    file(WRITE ${tree}/${file} "${content}")
    check(${rule} "${expected}")
endfunction()

make_tree()
check(layering "")
check(sizes "")
check(docs "")

refused(layering lib/alcove/grid/band.cpp "\n#include <vector>\n  # include \"alcove/field/field.h\"\n"
        "lib/alcove/grid/band.cpp:3: \"alcove/field/field.h\" is a back-edge")
refused(layering lib/alcove/base/types.h "#include \"alcove/mesh/mesh.h\"\n" "lib/alcove/base/types.h:1")
refused(layering lib/alcove/field/trace.cpp "#include \"alcove/grid/grid_stack.h\"\n"
        "lib/alcove/field/trace.cpp:1: \"alcove/grid/grid_stack.h\" is a back-edge")
refused(layering lib/alcove/occlusion/bake.cpp "#include \"alcove/render/image.h\"\n" "is a back-edge")
refused(layering lib/alcove/mesh/read.cpp "#include \"alcove/alcove.h\"\n" "is for users")
refused(layering lib/alcove/mesh/read.cpp "#include \"../grid/plan.h\"\n" "is relative")
refused(layering lib/alcove/shading/sun.cpp "#include <vector>\n" "is in a folder without a rule")
refused(layering lib/alcove/field/field.h "#include <openvdb/openvdb.h>\n" "lib/alcove/field/field.h:1")
refused(layering lib/alcove/field/field.h "#include <fmt/format.h>\n" "is third-party in a public header")
refused(layering lib/alcove/field/detail/bricks.h "#include \"alcove/grid/detail/vdb_grid.h\"\n" "brings openvdb")
refused(layering lib/alcove/field/field.h "#include \"alcove/field/detail/bricks.h\"\n" "is not installed, but this header is")
refused(layering lib/alcove/occlusion/bake.cpp "#include <embree3/rtcore.h>\n" "is embree")
refused(layering lib/alcove/grid/grid_io.cpp "#include <OpenEXR/ImfHeader.h>\n" "is openexr")
refused(layering apps/alcove/bake.cpp "#include \"alcove/grid/detail/vdb_grid.h\"\n" "apps/alcove/bake.cpp:1: \"alcove/grid/detail/vdb_grid.h\" brings openvdb")
refused(layering apps/alcove/bake.cpp "#include <tbb/parallel_for.h>\n" "is tbb")
refused(layering lib/alcove/field/primitives.h "#include <tuple>\n" "leaves out field/primitives.h")

make_tree()
foreach(i RANGE 1 8)
    file(WRITE ${tree}/lib/alcove/grid/more_${i}.cpp "#include <openvdb/openvdb.h>\n")
endforeach()
check(layering "10 sources include OpenVDB")

string(REPEAT "//\n" 401 long_file)
make_tree()
file(WRITE ${tree}/lib/alcove/grid/band.cpp "${long_file}")
execute_process(COMMAND ${CMAKE_COMMAND} -D TREE=${tree} -P ${CMAKE_CURRENT_LIST_DIR}/sizes.cmake
                RESULT_VARIABLE status ERROR_VARIABLE output)
if(NOT status EQUAL 0 OR NOT output MATCHES "lib/alcove/grid/band.cpp: 401 lines")
    message(FATAL_ERROR "sizes does not warn of a long file but: ${output}")
endif()
string(REPEAT "//\n" 121 long_header)
make_tree()
foreach(header base/types field/field field/detail/bricks)
    file(WRITE ${tree}/lib/alcove/${header}.h "${long_header}")
endforeach()
check(sizes "the median header has 121 lines")

refused(docs lib/alcove/mesh/mesh.cpp "" "docs/architecture.md does not list lib/alcove/mesh")
refused(docs docs/architecture.md "| `lib/alcove/base` | a |\n| `lib/alcove/attic` | b |\n" "there is no lib/alcove/attic")
make_tree()
file(WRITE ${tree}/examples/a.cpp "int main() {}\n")
file(WRITE ${tree}/docs/cpp.md "<!-- examples/a.cpp -->\n\n```cpp\nint main() { return 1; }\n```\n")
check(docs "docs/cpp.md does not quote examples/a.cpp as it is")
