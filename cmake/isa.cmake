# One object per instruction set.
#
# Files isa_*.c hold the loops that need wide vectors. On x86-64 each is compiled three
# times, with TOBI_ISA = v2, v3 and v4 (the psABI levels: SSE4.2, AVX2, AVX-512); elsewhere once, as
# v2 and without any machine flag. src/exec picks one set when the program starts. Everything else is
# compiled for the plain architecture, so the program starts on any machine of that architecture.
# The sanitizers have one set too, for AVX2, as v2: the checks make these files slow to compile. They do not mark
# where the life of each number of an inlined function ends: a third of the compile time, and no such pointer is kept.
# v2 does without gcc's global elimination on machine level: half of its compile time, nothing of its speed.
# All give up sooner where gcc asks what a load may have been written by: a fifth of the compile time of v2, no speed.
# v4 keeps to 256-bit registers: eight float lanes on every set, hence the same bits.

include(CheckCCompilerFlag)
set(TOBI_SHORT_WALKS --param=sccvn-max-alias-queries-per-access=50 --param=dse-max-alias-queries-per-store=32
    --param=dse-max-object-size=32)
check_c_compiler_flag("${TOBI_SHORT_WALKS}" TOBI_HAS_SHORT_WALKS)
if(NOT TOBI_HAS_SHORT_WALKS)
    set(TOBI_SHORT_WALKS)
endif()

# What an object library of rooms is compiled with.
function(tobi_room_target target)
    target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/src")
    target_link_libraries(${target} PRIVATE tobi_flags ${TOBI_LIBRARIES})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# Sets <out> to the objects of all isa_*.c files, for every set of this architecture.
function(tobi_isa_objects out)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/isa_*.c")
    set(flags_v2 "")
    set(sets v2)
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
        if(TOBI_SANITIZE)
            set(flags_v2 -march=x86-64-v3)
        else()
            set(sets v2 v3 v4)
            set(flags_v2 -march=x86-64-v2)
            set(flags_v3 -march=x86-64-v3)
            set(flags_v4 -march=x86-64-v4 -mprefer-vector-width=256)
            if(CMAKE_C_COMPILER_ID STREQUAL "GNU")
                list(APPEND flags_v2 -fno-gcse -fno-gcse-after-reload)
            endif()
        endif()
    endif()
    list(LENGTH sets count)
    target_compile_definitions(tobi_flags INTERFACE TOBI_ISA_SETS=${count})
    set(objects)
    if(files)
        foreach(isa IN LISTS sets)
            add_library(tobi_isa_${isa} OBJECT ${files})
            tobi_room_target(tobi_isa_${isa})
            target_compile_definitions(tobi_isa_${isa} PRIVATE TOBI_ISA=${isa})
            target_compile_options(tobi_isa_${isa} PRIVATE ${flags_${isa}} ${TOBI_SHORT_WALKS} ${TOBI_KERNEL_CHECKS})
            list(APPEND objects $<TARGET_OBJECTS:tobi_isa_${isa}>)
        endforeach()
    endif()
    set(${out} ${objects} PARENT_SCOPE)
endfunction()
