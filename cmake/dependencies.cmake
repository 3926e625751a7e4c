# Libraries, found through pkg-config. Sets TOBI_LIBRARIES (targets to link) and TOBI_PC_REQUIRES
# (module names, for tobiuo.pc). All missing ones are reported in one message.
find_package(PkgConfig)
if(NOT PKG_CONFIG_FOUND)
    message(FATAL_ERROR "pkg-config is missing. On Debian: apt-get install pkg-config\n"
                        "tools/install_packages.sh installs everything the build needs.")
endif()

set(TOBI_LIBRARIES)
set(TOBI_PC_REQUIRES)
set(missing)
set(packages)

# tobi_need(<name> <Debian package> <pkg-config module>...): the first module that exists is taken.
macro(tobi_need name package)
    pkg_search_module(${name} QUIET IMPORTED_TARGET ${ARGN})
    if(${name}_FOUND)
        list(APPEND TOBI_LIBRARIES PkgConfig::${name})
        string(APPEND TOBI_PC_REQUIRES "${${name}_MODULE_NAME} ")
    else()
        string(APPEND missing "\n  ${name} (Debian package ${package})")
        string(APPEND packages " ${package}")
    endif()
endmacro()

tobi_need(jansson libjansson-dev jansson)
tobi_need(assimp libassimp-dev assimp)
tobi_need(luajit libluajit-5.1-dev luajit)
tobi_need(hdf5 libhdf5-dev hdf5-serial hdf5)
tobi_need(zlib zlib1g-dev zlib)
tobi_need(lz4 liblz4-dev liblz4)
tobi_need(libmd libmd-dev libmd)
tobi_need(libpng libpng-dev libpng)
tobi_need(libjpeg libjpeg-dev libjpeg)
tobi_need(freetype libfreetype-dev freetype2)
tobi_need(fontconfig libfontconfig-dev fontconfig)

find_package(OpenMP QUIET COMPONENTS C)
if(NOT OpenMP_C_FOUND)
    string(APPEND missing
           "\n  OpenMP for ${CMAKE_C_COMPILER} (gcc has it; for clang: Debian package libomp-dev)")
endif()

if(missing)
    set(advice "\ntools/install_packages.sh installs everything the build needs.")
    if(packages)
        set(advice "\napt-get install${packages}${advice}")
    endif()
    message(FATAL_ERROR "Missing libraries:${missing}${advice}")
endif()
list(APPEND TOBI_LIBRARIES OpenMP::OpenMP_C m)
