-- The tail beat of the flying fish of scenes/flying_fish with folded wings, and nothing else: the fish swims
-- where the water lets it. Points come as the scene has placed and turned them; the shape is made in axes
-- of the fish, head at -x.
local pi, sin, cos, abs, min = math.pi, math.sin, math.cos, math.abs, math.min
local p = params
local cx, cy, cz = unpack(p.translation)        -- middle of the fish at rest, m
local c0, s0 = cos(math.rad(p.pitch)), sin(math.rad(p.pitch))
local length, half = p.length, p.width/2
local wing, chord, lead = p.wingspan/2 - half, p.wingchord, p.lead
local fan = math.rad(p.fold)/(pi/2)

local function ease(s) return (1 - cos(pi*min(1, math.max(0, s))))/2 end

-- How far the wings are folded: they spread again from p.spread on, within a tenth of a second.
local function folding(t) return 1 - ease((t - p.spread)/0.1) end

function deform(x, y, z, t)
    local dx, dz = x - cx, z - cz
    x, y, z = c0*dx - s0*dz, y - cy, s0*dx + c0*dz
    local out, side = abs(y) - half, y < 0 and -1 or 1

    -- A wave runs from head to tail and grows; the wings feel it less and less.
    local s = x + length/2
    local wave = ease(t*p.frequency/2)*p.amplitude*(s/length)^2*sin(2*pi*(s/p.wave - p.frequency*t))
    if out > 0 then wave = wave*(1 - min(1, out/wing))^2 end

    -- Wings turn about their roots, like a fan.
    local w = x + lead
    if out > 0 and w > -0.1*chord and w < 1.1*chord then
        local turn = fan*folding(t)*math.atan2(out, abs(w))
        local c, n = cos(turn), sin(turn)
        x, y = w*c + out*n - lead, side*(half + out*c - w*n)
    end
    y = y + wave
    return cx + c0*x + s0*z, cy + y, cz - s0*x + c0*z
end
