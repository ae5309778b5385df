// All of the engine: scenes, worlds, edits, queries. Files are read and written by <carom/io/...>.
#pragma once

#include <carom/core/scene.hpp>
#include <carom/core/snapshot.hpp>
#include <carom/parallel/edits.hpp>
#include <carom/parallel/kernel.hpp>
#include <carom/parallel/queries.hpp>
#include <carom/parallel/world.hpp>
