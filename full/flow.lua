function velocity(x, y, z) return 0, 0, 0 end
