-- Random velocities, up to params.speed along each axis, by a hash of the place.
local function random(x, y, n)
    local s = math.sin((x*127.1 + y*311.7)/params.spacing + n*74.7)*43758.5453
    return 2*(s - math.floor(s)) - 1
end

function velocity(x, y, z)
    return params.speed*random(x, y, 1), params.speed*random(x, y, 2), 0
end
