-- How the flying fish moves. Change it freely: no compiler is needed, only this file.
--
-- deform() gets a point of the fish at rest (x, y, z in metres: the mesh already moved to
-- params.translation, head at -x, z up) and the time t in seconds; it returns where the point is.
-- Four things happen, one after the other: the body waves, the wings fold and unfold, the nose
-- pitches up, and the whole fish travels. All numbers come from "params" in the scene.

local pi, sin, cos, abs, min = math.pi, math.sin, math.cos, math.abs, math.min
local p = params
local cx, cy, cz = unpack(p.translation)        -- centre of the fish at rest
local sx, sy, sz = unpack(p.startPosition)      -- where it begins to swim
local tx, ty, tz = unpack(p.swimmingPosition)   -- where it taxis
local length, half = p.fishLength, p.fishWidth / 2
local wing = p.wingspan / 2 - half              -- length of one wing from its root
local chord, lead = p.wingchord, p.LEPos        -- leading edge of the wing at x = -LEPos
local cycle, relax = 1 / p.freq, p.relax        -- one tail beat; time to get into position
local fan = (p.lagAngle or 80) / 90             -- the leading edge (90 degrees) folds by lagAngle
local pitch = math.rad(p.pitchAngle)

local function ease(s) return (1 - cos(pi * s)) / 2 end   -- from 0 to 1 with a soft start and end

-- How far the wings are folded at time t: 0 spread, 1 folded.
local function folding(t)
    if t <= 0 then return 0 end
    if t < relax then return ease(t / relax) end
    if t < relax + 2 * cycle then return 1 end
    if t < relax + 3 * cycle then return 1 - ease((t - relax - 2 * cycle) / cycle) end
    return 0
end

-- How far the fish has travelled from its rest position.
local function path(t)
    if t <= 0 then return 0, 0, 0 end
    local a = t < relax and ease(t / relax) or 1
    local b = t < relax and 0 or ease(min(1, (t - relax) / (2 * cycle)))
    return (sx - cx) * a + (tx - sx) * b, (sy - cy) * a + (ty - sy) * b, (sz - cz) * a + (tz - sz) * b
end

function deform(x, y, z, t)
    x, y, z = x - cx, y - cy, z - cz            -- seen from the fish
    local out = abs(y) - half                   -- distance from the wing root; negative: body
    local side = y < 0 and -1 or 1
    local ramp = t <= 0 and 0 or min(1, t / relax)

    -- Tail beat: a wave that runs from head to tail and grows; the wings feel it less and less.
    local s = x + length / 2
    local wave = ramp * p.amplitude / length * s * sin(2 * pi * (s / p.waveLength - p.freq * t))
    if out > 0 then wave = wave * (1 - min(1, out / wing)) ^ 2 end

    -- Wings: every point turns about the wing root by a share of its own angle to the body,
    -- like a fan: the leading edge by lagAngle, the root not at all.
    local w = x + lead                          -- distance behind the leading edge
    if out > 0 and w > -0.1 * chord and w < 1.1 * chord then
        local turn = fan * folding(t) * math.atan2(out, abs(w))
        local c, n = cos(turn), sin(turn)
        x, y = w * c + out * n - lead, side * (half + out * c - w * n)
    end
    y = y + wave

    -- Nose up, about the y axis; then to the place where the fish is at time t.
    local c, n = cos(pitch * ramp), sin(pitch * ramp)
    local dx, dy, dz = path(t)
    return c * x + n * z + cx + dx, y + cy + dy, c * z - n * x + cz + dz
end
