-- From rest to the speed along x: half a period of 1 - cos.
local p = params

function place(t)
    local w = math.pi/p.time
    return p.speed/2*(t - math.sin(w*t)/w), 0, 0
end
