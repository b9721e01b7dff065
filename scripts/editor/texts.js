'use strict'

const SHARED = '@nxline/node-red-serial-plc/plc-line:'

/** A text of the shared part of the catalogue, in the language of the browser. */
const t = (key, values) => RED._(`${SHARED}${key}`, values)

/** A text of a section of the catalogue; one that the language does not have, or that lacks a value, is `text` itself. */
const translate = (key, values, text) => {
  const translated = RED._(`${SHARED}${key}`, { ...values, defaultValue: text })
  // a detail that did not come with the error would leave a hole
  return /__\w+__/.test(translated) ? text : translated
}

/**
 * The text of an error with a code, in the language of the browser if its catalogue has the code. Its `reason` is the library's, unless the error
 * says by `why` which one it is; what it says of addresses depends on their `notation`.
 */
const errorText = error => {
  const text = String(error.message || error)
  const { code, details } = error
  if (!code || !details) return text
  const { why, notation, reason } = details
  const values = why ? { ...details, reason: translate(`why.${why}`, details, reason) } : details
  const general = translate(`error.${code}`, values, text)
  return notation ? translate(`error.${code}_${notation.toUpperCase()}`, values, general) : general
}

/** What is likely wrong, and what to do. @param {{ code: string, text: string, remedy: string, details?: any }} cause */
const causeText = ({ code, text, remedy, details }) =>
  translate(`cause.${code}`, details || {}, `${capital(text)}. ${remedy}`)

const capital = text => text.charAt(0).toUpperCase() + text.slice(1)

/** What a bad address cell says: the innermost reason, since the row already names itself. */
const reasonOf = error => errorText(error.cause && error.cause.code ? error.cause : error)

module.exports = { t, capital, causeText, errorText, reasonOf }
