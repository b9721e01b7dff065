'use strict'

/**
 * The straight line through points, by least squares.
 * @param {[number, number][]} points x and y
 * @returns {{ slope: number, error: number }} y per x, and its standard error
 */
function slopeOf(points) {
  const count = points.length
  const mean = at => points.reduce((sum, point) => sum + point[at], 0) / count
  const [x, y] = [mean(0), mean(1)]
  const sum = fn => points.reduce((total, [a, b]) => total + fn(a - x, b - y), 0)
  const spread = sum(dx => dx * dx)
  if (count < 3 || spread === 0) return { slope: NaN, error: NaN }
  const slope = sum((dx, dy) => dx * dy) / spread
  const rest = sum((dx, dy) => (dy - slope * dx) ** 2)
  return { slope, error: Math.sqrt(rest / (count - 2) / spread) }
}

module.exports = { slopeOf }
